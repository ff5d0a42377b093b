// SPDX-License-Identifier: MIT
// glTF and GLB files of every layout give the mesh that they were made from. Cut and damaged ones
// are refused.

#include "meshes/support/gltf_text.hpp"
#include "meshes/support/odd_file.hpp"

namespace cellist::test {
namespace {

using Triangle = std::vector<std::uint32_t>;

class GltfWriter {
public:
    explicit GltfWriter(unsigned seed) : random_(seed) {}

    OddFile write(const PlainMesh& mesh) {
        mesh_ = mesh;
        choose_transform();
        choose_format();
        // Each part of the triangles becomes a node with a mesh of its own.
        const std::size_t parts = 1 + random_() % 3;
        for (std::size_t part = 0; part < parts; ++part) {
            std::vector<Triangle> faces;
            for (std::size_t f = part; f < mesh_.faces.size(); f += parts)
                faces.push_back(mesh_.faces[f]);
            put_part(faces);
        }
        put_clutter();
        const bool is_glb = once_in(random_, 2);
        std::string text = is_glb ? scene_.glb() : scene_.gltf();
        if (!is_glb && once_in(random_, 4)) text = "\xEF\xBB\xBF" + text;
        if (!is_glb && once_in(random_, 2)) text += "\r\n";
        return {is_glb ? "m.glb" : "m.gltf", layout_, text};
    }

private:
    // A transform without rounding errors, and coordinates that it maps to those of the plain mesh.
    void choose_transform() {
        switch (random_() % 5) {
            case 0:
                break;
            case 1:
                layout_ += "translation ";
                node_["translation"] = {4, -8, 16};
                for (glm::dvec3& p : mesh_.positions) p -= glm::dvec3(4, -8, 16);
                break;
            case 2:  // mirrors, so that the file's triangles run clockwise
                layout_ += "mirror ";
                node_["scale"] = {-0.5, 1, 1};
                for (glm::dvec3& p : mesh_.positions) p.x *= -2;
                for (Triangle& t : mesh_.faces) std::swap(t[1], t[2]);
                break;
            case 3:
                layout_ += "rotation ";
                node_["rotation"] = {0, 0, 2, 0};
                for (glm::dvec3& p : mesh_.positions) p = {-p.x, -p.y, p.z};
                break;
            default:
                layout_ += "matrix ";
                node_["matrix"] = {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 1};
                for (glm::dvec3& p : mesh_.positions) p = {p.z, p.x - 2, p.y};
        }
    }

    void choose_format() {
        if (!node_.empty()) return;
        switch (random_() % 6) {
            case 0:
                quantize("short", 5122, 64, 0, false);
                break;
            case 1:
                quantize("unsigned short", 5123, 64, 8, false);
                break;
            case 2:
                quantize("normalized short", 5122, 64, 0, true);
                break;
            case 3:
                quantize("byte", 5120, 64, 0, false);
                break;
            default:
                break;
        }
    }

    // Integer coordinates, which the node's transform maps to those of the plain mesh.
    void quantize(const std::string& name, int type, double scale, double offset,
                  bool is_normalized) {
        layout_ += name + " ";
        type_ = type;
        scene_.root["extensionsUsed"] = {"KHR_mesh_quantization"};
        scene_.root["extensionsRequired"] = {"KHR_mesh_quantization"};
        is_normalized_ = is_normalized;
        const double unit = is_normalized ? 32767 / scale : 1 / scale;
        node_["scale"] = {unit, unit, unit};
        node_["translation"] = {-offset, -offset, -offset};
        for (glm::dvec3& p : mesh_.positions) p = (p + offset) * scale;
    }

    std::string bytes_of(const glm::dvec3& p) const {
        std::string bytes;
        for (const double value : {p.x, p.y, p.z}) {
            if (type_ == 5120) append_bytes(bytes, static_cast<std::int8_t>(value));
            if (type_ == 5122) append_bytes(bytes, static_cast<std::int16_t>(value));
            if (type_ == 5123) append_bytes(bytes, static_cast<std::uint16_t>(value));
            if (type_ == 5126) append_bytes(bytes, static_cast<float>(value));
        }
        bytes.resize((bytes.size() + 3) / 4 * 4);
        return bytes;
    }

    std::size_t put_positions(const std::vector<glm::dvec3>& positions) {
        std::string bytes;
        std::size_t stride = 0;
        const std::string gap(once_in(random_, 3) ? 4 * (1 + random_() % 4) : 0, '\x55');
        for (const glm::dvec3& p : positions) {
            const std::string vertex = bytes_of(p) + gap;
            stride = vertex.size();
            bytes += vertex;
        }
        const bool is_sparse = type_ == 5126 && once_in(random_, 4);
        if (is_sparse) return put_sparse(positions);
        const std::size_t head = once_in(random_, 3) ? 8 : 0;
        const std::size_t accessor =
            scene_.add_accessor(scene_.add_view(std::string(head, '\x33') + bytes, stride), type_,
                                "VEC3", positions.size());
        if (head > 0) scene_.root["accessors"][accessor]["byteOffset"] = head;
        if (is_normalized_) scene_.root["accessors"][accessor]["normalized"] = true;
        return accessor;
    }

    // Some or all of the elements replace those of a view, or zeros.
    std::size_t put_sparse(const std::vector<glm::dvec3>& positions) {
        layout_ += "sparse ";
        const bool has_view = once_in(random_, 2);
        std::string base, indices, values;
        std::size_t replaced = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const bool is_replaced = !has_view || once_in(random_, 2);
            base += bytes_of(is_replaced ? glm::dvec3(7, 7, 7) : positions[i]);
            if (!is_replaced) continue;
            ++replaced;
            append_bytes(indices, static_cast<std::uint16_t>(i));
            values += bytes_of(positions[i]);
        }
        json accessor = {{"componentType", 5126}, {"type", "VEC3"}, {"count", positions.size()}};
        if (has_view) accessor["bufferView"] = scene_.add_view(base);
        if (replaced > 0)
            accessor["sparse"] = {
                {"count", replaced},
                {"indices", {{"bufferView", scene_.add_view(indices)}, {"componentType", 5123}}},
                {"values", {{"bufferView", scene_.add_view(values)}}}};
        scene_.root["accessors"].push_back(accessor);
        return scene_.root["accessors"].size() - 1;
    }

    std::size_t put_indices(const Triangle& indices) {
        switch (random_() % 3) {
            case 0:
                return scene_.add_values(std::vector<std::uint8_t>(indices.begin(), indices.end()),
                                         5121, "SCALAR", 1);
            case 1:
                return scene_.add_values(std::vector<std::uint16_t>(indices.begin(), indices.end()),
                                         5123, "SCALAR", 1);
            default:
                return scene_.add_values(indices, 5125, "SCALAR", 1);
        }
    }

    void put_part(std::vector<Triangle> faces) {
        switch (random_() % 4) {
            case 0:
                layout_ += "soup ";
                put_soup(faces);
                break;
            case 1:
                layout_ += "strips ";
                while (!faces.empty()) put_indexed(take_strip(faces), 5);
                break;
            case 2:
                layout_ += "fans ";
                while (!faces.empty()) put_indexed(take_fan(faces), 6);
                break;
            default: {
                layout_ += "triangles ";
                Triangle indices;
                for (const Triangle& t : faces) indices.insert(indices.end(), t.begin(), t.end());
                put_indexed(indices, 4);
            }
        }
    }

    // Takes a triangle that has this directed edge, and gives its other corner.
    static bool take_neighbour(std::vector<Triangle>& faces, std::uint32_t a, std::uint32_t b,
                               std::uint32_t& other) {
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k)
                if (faces[f][k] == a && faces[f][(k + 1) % 3] == b) {
                    other = faces[f][(k + 2) % 3];
                    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(f));
                    return true;
                }
        return false;
    }

    // Triangle i of a strip is (i, i + 1, i + 2) where i is even, and (i, i + 2, i + 1) where not.
    static Triangle take_strip(std::vector<Triangle>& faces) {
        Triangle strip = faces.back();
        faces.pop_back();
        for (;;) {
            const std::size_t i = strip.size() - 2;
            const std::uint32_t a = strip[i], b = strip[i + 1];
            std::uint32_t next = 0;
            if (!(i % 2 == 0 ? take_neighbour(faces, a, b, next)
                             : take_neighbour(faces, b, a, next)))
                return strip;
            strip.push_back(next);
        }
    }

    static Triangle take_fan(std::vector<Triangle>& faces) {
        Triangle fan = faces.back();
        faces.pop_back();
        for (std::uint32_t next = 0; take_neighbour(faces, fan[0], fan.back(), next);)
            fan.push_back(next);
        return fan;
    }

    void put_indexed(const Triangle& indices, int mode) {
        std::vector<glm::dvec3> positions = mesh_.positions;
        if (once_in(random_, 3)) positions.emplace_back(100, 0, 0);  // unused
        json primitive = {{"indices", put_indices(indices)}};
        if (mode != 4 || once_in(random_, 2)) primitive["mode"] = mode;
        put_primitive(primitive, positions);
    }

    void put_soup(const std::vector<Triangle>& faces) {
        std::vector<glm::dvec3> positions;
        for (const Triangle& t : faces)
            for (const std::uint32_t v : t) positions.push_back(mesh_.positions[v]);
        put_primitive(json::object(), positions);
    }

    void put_primitive(json primitive, std::vector<glm::dvec3> positions) {
        json node = node_;
        if (type_ == 5126 && once_in(random_, 6)) {
            layout_ += "morph ";
            const std::vector<glm::dvec3> offset(positions.size(), glm::dvec3(0.5, 1, -2));
            for (glm::dvec3& p : positions) p -= 0.5 * offset[0];
            std::string bytes;
            for (const glm::dvec3& p : offset) bytes += bytes_of(p);
            const std::size_t target =
                scene_.add_accessor(scene_.add_view(bytes), 5126, "VEC3", offset.size());
            primitive["targets"] = {{{"POSITION", target}}, {{"POSITION", target}}};
            node["weights"] = {0.5, 0};
        }
        if (once_in(random_, 6)) put_skin(primitive, node, positions.size());
        if (once_in(random_, 4))
            primitive["attributes"]["COLOR_0"] =
                scene_.add_values(std::vector<float>(3 * positions.size(), 0.5F), 5126, "VEC3", 3);
        primitive["attributes"]["POSITION"] = put_positions(positions);
        if (once_in(random_, 4)) {
            // Of two nodes, the parent places the child.
            scene_.add_primitive(primitive, {});
            auto& nodes = scene_.root["nodes"];
            json child = nodes.back();
            if (node.contains("skin")) child["skin"] = node["skin"];
            if (node.contains("weights")) child["weights"] = node["weights"];
            node.erase("skin");
            node.erase("weights");
            node["children"] = {nodes.size()};
            nodes.back() = node;
            nodes.push_back(child);
            return;
        }
        scene_.add_primitive(primitive, node);
    }

    // The joint has the node's old transform, and the node's own transform must have no effect.
    void put_skin(json& primitive, json& node, std::size_t vertices) {
        layout_ += "skin ";
        std::vector<std::uint8_t> weights;
        for (std::size_t i = 0; i < vertices; ++i) weights.insert(weights.end(), {255, 0, 0, 0});
        primitive["attributes"]["JOINTS_0"] =
            scene_.add_values(std::vector<std::uint8_t>(4 * vertices, 0), 5121, "VEC4", 4);
        const std::size_t accessor = scene_.add_values(weights, 5121, "VEC4", 4);
        scene_.root["accessors"][accessor]["normalized"] = true;
        primitive["attributes"]["WEIGHTS_0"] = accessor;
        json joint = node_.empty() ? json::object() : node_;
        scene_.root["nodes"].push_back(joint);
        scene_.root["skins"].push_back({{"joints", {scene_.root["nodes"].size() - 1}}});
        node = {{"skin", scene_.root["skins"].size() - 1},
                {"translation", {50, 50, 50}},
                {"weights", node.value("weights", json::array({0.5, 0}))}};
    }

    // Adds parts that draw no triangle.
    void put_clutter() {
        json& root = scene_.root;
        if (once_in(random_, 3))
            scene_.add_primitive({{"mode", random_() % 4},
                                  {"attributes", {{"POSITION", put_positions(mesh_.positions)}}}});
        if (once_in(random_, 3)) root["extras"] = {{"a", {1, 2, {{"b", "\xC3\xA9 \" ] }"}}}}};
        if (once_in(random_, 3)) root["cameras"] = {{{"type", "perspective"}}};
        if (once_in(random_, 3)) root["nodes"].push_back({{"name", "outside of the scene"}});
        if (once_in(random_, 3)) root["extensionsUsed"].push_back("VENDOR_unknown");
        if (once_in(random_, 3)) root["asset"]["generator"] = "odd";
        if (once_in(random_, 4) && !root.contains("skins")) {
            // Without a scene, all roots are drawn.
            root.erase("scene");
            root.erase("scenes");
        } else if (once_in(random_, 3)) {
            root.erase("scene");
        }
    }

    Random random_;
    GltfScene scene_;
    PlainMesh mesh_;
    json node_ = json::object();
    std::string layout_;
    int type_ = 5126;
    bool is_normalized_ = false;
};

TEST_CASE("glTF files of 500 layouts give their mesh") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    for (unsigned seed = 0; seed < 500; ++seed) {
        const OddFile file = GltfWriter(seed).write(plain);
        const std::string problem = problem_of_whole(folder, file, plain);
        INFO("seed " << seed << ": " << file.layout);
        CHECK(problem == "");
    }
}

TEST_CASE("glTF files that are cut are refused") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    Random random(7);
    for (unsigned seed = 0; seed < 6; ++seed) {
        const OddFile file = GltfWriter(seed).write(plain);
        for (int i = 0; i < 200; ++i) {
            const std::size_t size = random() % file.bytes.size();
            INFO(file.layout << ", cut after " << size << " of " << file.bytes.size());
            CHECK(problem_of_cut(folder, file, size, plain) == "");
        }
    }
}

TEST_CASE("glTF files with changed bytes are refused, or can be drawn") {
    const Folder folder;
    Random random(8);
    for (unsigned seed = 0; seed < 10; ++seed)
        check_flips(folder, GltfWriter(seed).write(icosphere()), random, 60);
}

}  // namespace
}  // namespace cellist::test
