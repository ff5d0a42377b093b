// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "gltf_accessor.hpp"
#include "gltf_file.hpp"
#include "gltf_materials.hpp"
#include "gltf_nodes.hpp"
#include "gltf_skin.hpp"
#include "placement.hpp"
#include "raw_mesh.hpp"
#include "text.hpp"

namespace support {
namespace {

// Elements that instances of meshes may add to those of the file. Bounds the memory for a small
// file.
constexpr std::uint64_t limit_repeated_elements = std::uint64_t{1} << 26;

// Extensions that do not change what is drawn: positions, base colours and opacities.
bool is_harmless(std::string_view extension) {
    constexpr std::array<std::string_view, 15> names = {"EXT_lights_image_based",
                                                        "KHR_animation_pointer",
                                                        "KHR_lights_punctual",
                                                        "KHR_materials_anisotropy",
                                                        "KHR_materials_clearcoat",
                                                        "KHR_materials_emissive_strength",
                                                        "KHR_materials_ior",
                                                        "KHR_materials_iridescence",
                                                        "KHR_materials_sheen",
                                                        "KHR_materials_specular",
                                                        "KHR_materials_unlit",
                                                        "KHR_materials_pbrSpecularGlossiness",
                                                        "KHR_mesh_quantization",
                                                        "KHR_xmp_json_ld",
                                                        "KHR_xmp"};
    return extension.starts_with("KHR_texture_") || extension.starts_with("EXT_texture_") ||
           extension.starts_with("MSFT_texture_") ||
           std::find(names.begin(), names.end(), extension) != names.end();
}

// Extensions that are optional in a file only if it also has the plain data.
bool has_fallback(std::string_view extension) {
    return extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression" ||
           extension == "KHR_meshopt_compression" || extension == "KHR_materials_variants";
}

class GltfReader {
public:
    GltfReader(const std::filesystem::path& path, const std::string& text) : file_(path, text) {}

    RawMesh read() {
        check_extensions();
        mesh_.up = UpAxis::y;
        mesh_.drops.bytes_after_end = file_.bytes_after_end();
        materials_ = read_gltf_materials(file_);
        material_is_used_.resize(materials_.size());
        nodes_ = place_gltf_nodes(file_, mesh_.notes);
        for (const std::size_t node : nodes_.drawn) draw_node(node);
        add_materials();
        return std::move(mesh_);
    }

private:
    void add_materials() {
        if (materials_.empty()) {
            mesh_.face_materials.clear();
            return;
        }
        for (std::size_t i = 0; i < materials_.size(); ++i) {
            mesh_.materials.push_back(materials_[i].look);
            if (material_is_used_[i]) mesh_.ignored_textures += materials_[i].textures;
        }
        mesh_.materials.emplace_back();  // of primitives without a material
        if (masked_ > 0)
            mesh_.notes.push_back(
                "triangles with alpha below their material's cutoff, which are "
                "not drawn: " +
                std::to_string(masked_));
        if (partly_masked_ > 0)
            mesh_.notes.push_back(
                "triangles with alpha below their material's cutoff at some "
                "corners, which are drawn whole: " +
                std::to_string(partly_masked_));
    }

    void check_extensions() {
        if (const auto required = file_.root().find("extensionsRequired"))
            for (std::size_t i = 0; i < required->size(); ++i)
                if (const std::string& name = (*required)[i].text(); !is_harmless(name))
                    (*required)[i].fail("requires the extension '" + printable(name) +
                                        "', which this program does not support");
        if (const auto used = file_.root().find("extensionsUsed"))
            for (std::size_t i = 0; i < used->size(); ++i)
                if (const std::string& name = (*used)[i].text();
                    !is_harmless(name) && !has_fallback(name))
                    mesh_.notes.push_back("the extension '" + printable(name) + "' is not applied");
        quantized_ = file_.uses_extension("KHR_mesh_quantization");
    }

    // Nodes may share meshes, and meshes accessors, so a small file can ask for any amount of work.
    void charge(const GltfValue& place, std::uint64_t elements) {
        work_ += elements + 1;
        const std::uint64_t limit = limit_repeated_elements + file_.size_bytes();
        if (work_ > limit)
            place.fail("instances of meshes have more than " + std::to_string(limit) +
                       " vertices and indices, the limit");
    }

    void draw_node(std::size_t number) {
        const GltfValue node = file_.root().at("nodes")[number];
        const auto index = node.find("mesh");
        if (!index) return;
        const GltfValue mesh = file_.element("meshes", *index);
        const GltfValue primitives = mesh.at("primitives");
        std::vector<double> weights;
        auto default_weights = node.find("weights");
        if (!default_weights) default_weights = mesh.find("weights");
        if (default_weights) weights = default_weights->numbers(default_weights->size());
        charge(node, weights.size());
        for (std::size_t i = 0; i < primitives.size(); ++i)
            draw_primitive(primitives[i], node, nodes_.worlds[number], weights);
    }

    void draw_primitive(const GltfValue& primitive, const GltfValue& node, const glm::dmat4& world,
                        const std::vector<double>& weights) {
        charge(primitive, 64);  // for the work on its JSON
        const GltfValue attributes = primitive.at("attributes");
        const auto position = attributes.find("POSITION");
        if (!position) return;  // as the specification says
        const std::uint64_t mode = primitive.find("mode") ? primitive.at("mode").integer(6) : 4;
        const auto indices = primitive.find("indices");
        if (mode < 4) {
            const std::size_t corners = gltf_accessor_size(file_, indices ? *indices : *position);
            const bool is_line_strip = mode == 3 && corners > 0;
            mesh_.drops.points_and_lines +=
                mode == 1 ? corners / 2 : corners - static_cast<std::size_t>(is_line_strip);
            return;
        }
        refuse_compressed(primitive, *position);

        const std::size_t first = mesh_.positions.size();
        std::vector<glm::dvec3> positions = read_positions(*position);
        std::vector<glm::dvec3> normals = read_normals(attributes, positions.size());
        add_morphs(primitive, weights, positions, normals);
        read_colours(attributes, first, positions.size());
        const bool mirrored = place(node, attributes, world, positions, normals);
        const std::uint32_t material = use_material(primitive);
        add_triangles(primitive, mode, indices, first, positions.size(), mirrored, material);
        drop_unused_alphas(material, first);
    }

    // Its accessors have no data of their own.
    void refuse_compressed(const GltfValue& primitive, const GltfValue& position) const {
        const auto extensions = primitive.find("extensions");
        if (!extensions || !extensions->find("KHR_draco_mesh_compression")) return;
        const GltfValue accessor = file_.element("accessors", position);
        if (!accessor.find("bufferView"))
            primitive.fail(
                "has data only for the extension 'KHR_draco_mesh_compression', which "
                "this program does not support");
    }

    [[nodiscard]] std::vector<glm::dvec3> read_vectors(const GltfAccessor& accessor) const {
        std::vector<glm::dvec3> out(accessor.size());
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = {accessor.number(i, 0), accessor.number(i, 1), accessor.number(i, 2)};
        return out;
    }

    // Positions and normals may be integers only if the file uses KHR_mesh_quantization.
    [[nodiscard]] GltfAccessor open_vectors(const GltfValue& index,
                                            std::initializer_list<GltfFormat> quantized) {
        GltfAccessor accessor = quantized_ ? GltfAccessor(file_, index, {"VEC3"}, quantized)
                                           : GltfAccessor(file_, index, {"VEC3"}, {gltf_float32});
        charge(index, accessor.size());
        return accessor;
    }

    [[nodiscard]] GltfAccessor open_positions(const GltfValue& index) {
        return open_vectors(index, {gltf_float32,
                                    gltf_unit_uint8,
                                    gltf_unit_uint16,
                                    {GltfType::int8, true},
                                    {GltfType::int16, true},
                                    {GltfType::int8, false},
                                    {GltfType::uint8, false},
                                    {GltfType::int16, false},
                                    {GltfType::uint16, false}});
    }

    [[nodiscard]] GltfAccessor open_normals(const GltfValue& index) {
        return open_vectors(index, {gltf_float32, {GltfType::int8, true}, {GltfType::int16, true}});
    }

    [[nodiscard]] std::vector<glm::dvec3> read_positions(const GltfValue& index) {
        return read_vectors(open_positions(index));
    }

    void check_count(const GltfValue& attribute, std::size_t count, std::size_t vertices) const {
        if (count != vertices)
            attribute.fail("has " + std::to_string(count) + " elements, POSITION has " +
                           std::to_string(vertices));
    }

    // The normals; zeros where the primitive has none.
    [[nodiscard]] std::vector<glm::dvec3> read_normals(const GltfValue& attributes,
                                                       std::size_t vertices) {
        const auto normal = attributes.find("NORMAL");
        if (!normal) return std::vector<glm::dvec3>(vertices, glm::dvec3(0));
        const GltfAccessor accessor = open_normals(*normal);
        check_count(*normal, accessor.size(), vertices);
        return read_vectors(accessor);
    }

    void add_morphs(const GltfValue& primitive, const std::vector<double>& weights,
                    std::vector<glm::dvec3>& positions, std::vector<glm::dvec3>& normals) {
        const auto targets = primitive.find("targets");
        if (!targets) return;
        for (std::size_t t = 0; t < std::min(targets->size(), weights.size()); ++t) {
            if (weights[t] == 0) continue;
            if (const auto position = (*targets)[t].find("POSITION")) {
                const GltfAccessor offsets = open_positions(*position);
                check_count(*position, offsets.size(), positions.size());
                for (std::size_t i = 0; i < positions.size(); ++i)
                    positions[i] +=
                        weights[t] * glm::dvec3(offsets.number(i, 0), offsets.number(i, 1),
                                                offsets.number(i, 2));
            }
            if (const auto normal = (*targets)[t].find("NORMAL")) {
                const GltfAccessor offsets = open_normals(*normal);
                check_count(*normal, offsets.size(), normals.size());
                for (std::size_t i = 0; i < normals.size(); ++i)
                    normals[i] +=
                        weights[t] * glm::dvec3(offsets.number(i, 0), offsets.number(i, 1),
                                                offsets.number(i, 2));
            }
        }
    }

    void read_colours(const GltfValue& attributes, std::size_t first, std::size_t vertices) {
        const auto colour = attributes.find("COLOR_0");
        if (!colour) {
            if (!mesh_.colours.empty()) mesh_.colours.resize(first + vertices, glm::vec4(1));
            return;
        }
        const GltfAccessor accessor(file_, *colour, {"VEC4", "VEC3"},
                                    {gltf_float32, gltf_unit_uint8, gltf_unit_uint16});
        charge(*colour, accessor.size());
        check_count(*colour, accessor.size(), vertices);
        mesh_.colours.resize(first + vertices, glm::vec4(1));
        for (std::size_t i = 0; i < vertices; ++i)
            for (std::size_t c = 0; c < accessor.components(); ++c) {
                const double value = accessor.number(i, c);
                mesh_.colours[first + i][static_cast<int>(c)] =
                    value > 0 ? to_float(std::min(value, 1.0)) : 0;
            }
    }

    [[nodiscard]] std::optional<GltfSkin> open_skin(const GltfValue& node,
                                                    const GltfValue& attributes,
                                                    std::size_t vertices) {
        const auto index = node.find("skin");
        if (!index || !attributes.find("JOINTS_0") || !attributes.find("WEIGHTS_0"))
            return std::nullopt;
        const std::size_t number = file_.element_index("skins", *index);
        auto known = joints_.find(number);
        if (known == joints_.end()) {
            const GltfValue skin = file_.element("skins", *index);
            charge(skin, skin.at("joints").size());
            if (const auto inverses = skin.find("inverseBindMatrices"))
                charge(skin, gltf_accessor_size(file_, *inverses));
            known = joints_.emplace(number, place_gltf_joints(file_, skin, nodes_.worlds)).first;
        }
        charge(*index, 2 * vertices);
        return GltfSkin(file_, known->second, attributes, vertices);
    }

    // Adds the vertices in the scene. Returns whether their transform mirrors them.
    [[nodiscard]] bool place(const GltfValue& node, const GltfValue& attributes,
                             const glm::dmat4& world, const std::vector<glm::dvec3>& positions,
                             const std::vector<glm::dvec3>& normals) {
        const std::optional<GltfSkin> skin = open_skin(node, attributes, positions.size());
        // Joints replace the transform of the node.
        const Placement first(skin && !positions.empty() ? skin->matrix_of(0) : world);
        for (std::size_t i = 0; i < positions.size(); ++i)
            (skin && i > 0 ? Placement(skin->matrix_of(i)) : first)
                .add(positions[i], normals[i], mesh_);
        return !positions.empty() && first.mirrors();
    }

    void add_triangles(const GltfValue& primitive, std::uint64_t mode,
                       const std::optional<GltfValue>& indices, std::size_t first,
                       std::size_t vertices, bool mirrored, std::uint32_t material) {
        std::optional<GltfAccessor> accessor;
        if (indices)
            accessor.emplace(file_, *indices, std::initializer_list<std::string_view>{"SCALAR"},
                             std::initializer_list<GltfFormat>{{GltfType::uint8, false},
                                                               {GltfType::uint16, false},
                                                               {GltfType::uint32, false}});
        const std::size_t corners = accessor ? accessor->size() : vertices;
        charge(primitive, 3 * corners);
        if (mode == 4 && corners % 3 != 0)
            primitive.fail("has " + std::to_string(corners) +
                           " corners of triangles, which is not a multiple of 3");
        const std::size_t triangles =
            mode == 4 ? corners / 3 : std::max<std::size_t>(corners, 2) - 2;
        if (mesh_.positions.size() > RawMesh::most ||
            triangles > (RawMesh::most - mesh_.corners.size()) / 3)
            primitive.fail("the meshes have more than 4294967294 vertices or corners, the limit");
        for (std::size_t t = 0; t < triangles; ++t) {
            std::array<std::size_t, 3> at = {3 * t, 3 * t + 1, 3 * t + 2};
            if (mode == 5) at = {t, t + 1 + t % 2, t + 2 - t % 2};
            if (mode == 6) at = {t + 1, t + 2, 0};
            if (mirrored) std::swap(at[1], at[2]);
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t index = accessor ? accessor->index(at[k]) : at[k];
                triangle[k] = index < vertices ? static_cast<std::uint32_t>(first + index)
                                               : RawMesh::no_vertex;
            }
            if (count_masked(triangle, material)) continue;
            mesh_.corners.insert(mesh_.corners.end(), triangle.begin(), triangle.end());
            mesh_.face_ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
            mesh_.face_materials.push_back(material);
        }
    }

    // The alphas of vertices count only where the material blends, and for its mask.
    void drop_unused_alphas(std::uint32_t material, std::size_t first) {
        if (material < materials_.size() && materials_[material].alpha != GltfAlpha::blend)
            for (std::size_t i = first; i < mesh_.colours.size(); ++i) mesh_.colours[i].a = 1;
    }

    [[nodiscard]] std::uint32_t use_material(const GltfValue& primitive) {
        const auto index = primitive.find("material");
        if (!index) return static_cast<std::uint32_t>(materials_.size());
        const std::size_t material = file_.element_index("materials", *index);
        material_is_used_[material] = true;
        return static_cast<std::uint32_t>(material);
    }

    // Counts a triangle with corners below the alpha at which its material becomes visible. Returns
    // whether all three are, so that it is not drawn.
    [[nodiscard]] bool count_masked(const std::array<std::uint32_t, 3>& triangle,
                                    std::uint32_t material) {
        if (material >= materials_.size() || materials_[material].alpha != GltfAlpha::mask)
            return false;
        std::size_t below = 0;
        for (const std::uint32_t vertex : triangle) {
            const double alpha =
                vertex < mesh_.colours.size() ? static_cast<double>(mesh_.colours[vertex].a) : 1;
            if (alpha * materials_[material].factor_alpha < materials_[material].cutoff) ++below;
        }
        if (below == 3)
            ++masked_;
        else if (below > 0)
            ++partly_masked_;
        return below == 3;
    }

    GltfFile file_;
    GltfNodes nodes_;
    std::vector<GltfMaterial> materials_;
    std::map<std::size_t, std::vector<glm::dmat4>> joints_;  // of each skin
    std::vector<bool> material_is_used_;
    RawMesh mesh_;
    bool quantized_ = false;
    std::uint64_t work_ = 0;
    std::uint64_t masked_ = 0, partly_masked_ = 0;
};

}  // namespace

RawMesh read_gltf(const std::filesystem::path& path, const std::string& text) {
    return GltfReader(path, text).read();
}

}  // namespace support
