// SPDX-License-Identifier: MIT
#include "gltf_nodes.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace support {
namespace {

glm::dvec3 vector_or(const GltfValue& node, const char* key, const glm::dvec3& fallback) {
    const std::optional<GltfValue> value = node.find(key);
    if (!value) return fallback;
    const std::vector<double> v = value->numbers(3);
    return {v[0], v[1], v[2]};
}

glm::dmat3 rotation(const GltfValue& node) {
    const std::optional<GltfValue> value = node.find("rotation");
    if (!value) return glm::dmat3(1);
    const std::vector<double> q = value->numbers(4);
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !std::isfinite(length)) value->fail("is not a rotation");
    const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

glm::dmat4 local_transform(const GltfValue& node) {
    if (const std::optional<GltfValue> matrix = node.find("matrix")) {
        const std::vector<double> m = matrix->numbers(16);
        glm::dmat4 out;
        for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
        return out;
    }
    const glm::dvec3 scale = vector_or(node, "scale", glm::dvec3(1));
    const glm::dmat3 turn = rotation(node);
    glm::dmat4 out(1);
    for (int axis = 0; axis < 3; ++axis) out[axis] = glm::dvec4(turn[axis] * scale[axis], 0);
    out[3] = glm::dvec4(vector_or(node, "translation", glm::dvec3(0)), 1);
    return out;
}

// The nodes that an array names, "children" of a node or "nodes" of a scene.
std::vector<std::size_t> node_indices(const GltfFile& file, const GltfValue& owner,
                                      const char* key) {
    std::vector<std::size_t> out;
    if (const std::optional<GltfValue> nodes = owner.find(key))
        for (std::size_t i = 0; i < nodes->size(); ++i)
            out.push_back(file.element_index("nodes", (*nodes)[i]));
    return out;
}

}  // namespace

GltfNodes place_gltf_nodes(const GltfFile& file, std::vector<std::string>& notes) {
    const std::size_t count = file.count("nodes");
    GltfNodes nodes;
    if (count == 0) return nodes;
    const GltfValue array = file.root().at("nodes");
    std::vector<std::vector<std::size_t>> children(count);
    std::vector<bool> has_parent(count);
    for (std::size_t i = 0; i < count; ++i) {
        nodes.worlds.push_back(local_transform(array[i]));
        children[i] = node_indices(file, array[i], "children");
        for (const std::size_t child : children[i]) {
            if (has_parent[child])
                array[i].fail("node " + std::to_string(child) + " is listed as a child twice");
            has_parent[child] = true;
        }
    }

    std::vector<std::size_t> roots, stack;
    for (std::size_t i = 0; i < count; ++i)
        if (!has_parent[i]) roots.push_back(i);
    // Every node has at most one parent, so the nodes that no root reaches form cycles.
    std::size_t reached = 0;
    for (stack = roots; !stack.empty(); ++reached) {
        const std::size_t node = stack.back();
        stack.pop_back();
        for (const std::size_t child : children[node]) {
            nodes.worlds[child] = nodes.worlds[node] * nodes.worlds[child];
            stack.push_back(child);
        }
    }
    if (reached != count) array.fail("nodes that form cycles: " + std::to_string(count - reached));

    stack = roots;
    if (const std::size_t scenes = file.count("scenes"); scenes > 0) {
        const std::optional<GltfValue> chosen = file.root().find("scene");
        const std::size_t scene = chosen ? file.element_index("scenes", *chosen) : 0;
        if (scenes > 1)
            notes.push_back("/scenes: scene " + std::to_string(scene) + " of " +
                            std::to_string(scenes) + " is drawn");
        const GltfValue value = file.root().at("scenes")[scene];
        stack = node_indices(file, value, "nodes");
        std::vector<bool> listed(count);
        for (const std::size_t node : stack) {
            if (has_parent[node] || listed[node])
                value.fail("node " + std::to_string(node) + " is not a root, or is listed twice");
            listed[node] = true;
        }
    }
    while (!stack.empty()) {
        const std::size_t node = stack.back();
        stack.pop_back();
        nodes.drawn.push_back(node);
        stack.insert(stack.end(), children[node].begin(), children[node].end());
    }
    return nodes;
}

}  // namespace support
