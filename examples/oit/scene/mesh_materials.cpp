// SPDX-License-Identifier: MIT
#include "scene/mesh_materials.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include <glm/common.hpp>

namespace oit {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// NaN becomes 0.
float unit(float value) { return value > 0 ? std::min(value, 1.0F) : 0.0F; }

bool has_opacities(const support::Mesh& mesh, const Triangle& triangle) {
    return !mesh.colours.empty() && std::ranges::any_of(triangle, [&](std::uint32_t vertex) {
        return unit(mesh.colours[vertex].w) < 1;
    });
}

// `fades`: vertices of the material have opacities less than 1.
Material material_of(const support::MeshMaterial& said, bool has_colours, bool fades, float alpha,
                     std::optional<float> own_alpha) {
    std::optional<float> opacity = own_alpha ? own_alpha : said.opacity;
    if (!opacity && fades) opacity = 1;
    Material material = glass(unit(opacity.value_or(alpha)));
    if (said.base_colour || has_colours) {
        const glm::vec3 colour = said.base_colour.value_or(glm::vec3(1));
        for (int c = 0; c < 3; ++c)
            material.front_tint[c] = material.back_tint[c] = unit(colour[c]);
    }
    if (opacity && material.alpha == 1 && !fades)
        material.blend = static_cast<cl_uint>(Blend::opaque);
    return material;
}

// Materials with the same key look the same.
using MaterialKey = std::array<float, 8>;
MaterialKey key_of(const Material& m) {
    return {m.front_tint[0], m.front_tint[1], m.front_tint[2], m.back_tint[0],
            m.back_tint[1],  m.back_tint[2],  m.alpha,         static_cast<float>(m.blend)};
}

// The triangles of a mesh that have one material.
struct MaterialGroup {
    Material material = {};
    std::vector<Triangle> triangles = {};
};

// The part of a mesh with these triangles. Vertices keep their order, so that coincident triangles
// still start at the same corner.
support::Mesh part_of(const support::Mesh& mesh, std::vector<Triangle> triangles) {
    std::vector<std::uint32_t> used;
    used.reserve(3 * triangles.size());
    for (const Triangle& triangle : triangles)
        used.insert(used.end(), triangle.begin(), triangle.end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    support::Mesh part;
    for (const std::uint32_t vertex : used) {
        part.positions.push_back(mesh.positions[vertex]);
        part.normals.push_back(mesh.normals[vertex]);
        if (!mesh.colours.empty()) part.colours.push_back(mesh.colours[vertex]);
    }
    for (Triangle& triangle : triangles)
        for (std::uint32_t& vertex : triangle)
            vertex =
                static_cast<std::uint32_t>(std::ranges::lower_bound(used, vertex) - used.begin());
    part.triangles = std::move(triangles);
    return part;
}

Model model_of(support::Mesh mesh, bool keeps_opacities) {
    Model model;
    const std::vector<glm::vec4> colours = std::exchange(mesh.colours, {});
    const auto any = [&](const auto& differs) { return std::ranges::any_of(colours, differs); };
    if (any([](const glm::vec4& c) { return glm::vec3(c) != glm::vec3(1); }))
        for (const glm::vec4& c : colours)
            model.tints.emplace_back(unit(c.x), unit(c.y), unit(c.z));
    if (keeps_opacities && any([](const glm::vec4& c) { return unit(c.w) < 1; }))
        for (const glm::vec4& c : colours) model.opacities.push_back(unit(c.w));
    mesh.materials.clear();
    mesh.triangle_materials.clear();
    model.mesh = std::move(mesh);
    return model;
}

}  // namespace

void add_mesh(Scene& scene, support::Mesh mesh, float alpha, std::optional<float> own_alpha) {
    const auto add = [&](support::Mesh part, const Material& material) {
        scene.instances.push_back(
            {.model = scene.models.size(), .material = scene.materials.size()});
        scene.models.push_back(model_of(std::move(part), !own_alpha));
        scene.materials.push_back(material);
    };
    // The last one is that of triangles without a material.
    std::vector<support::MeshMaterial> said = mesh.materials;
    said.emplace_back();
    const auto index_of = [&](std::size_t triangle) {
        return mesh.triangle_materials.empty()
                   ? said.size() - 1
                   : std::min<std::size_t>(mesh.triangle_materials[triangle], said.size() - 1);
    };
    std::vector<char> fades(said.size(), 0);
    if (!own_alpha)
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            if (has_opacities(mesh, mesh.triangles[t])) fades[index_of(t)] = 1;

    std::map<MaterialKey, MaterialGroup> groups;
    std::vector<MaterialGroup*> group_of;
    for (std::size_t i = 0; i < said.size(); ++i) {
        const Material material =
            material_of(said[i], !mesh.colours.empty(), fades[i] != 0, alpha, own_alpha);
        group_of.push_back(&groups[key_of(material)]);
        group_of.back()->material = material;
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        group_of[index_of(t)]->triangles.push_back(mesh.triangles[t]);
    std::erase_if(groups, [](const auto& entry) { return entry.second.triangles.empty(); });
    if (groups.size() == 1) {
        add(std::move(mesh), groups.begin()->second.material);
        return;
    }
    for (auto& [key, group] : groups)
        add(part_of(mesh, std::move(group.triangles)), group.material);
}

}  // namespace oit
