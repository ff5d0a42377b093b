// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "gltf_file.hpp"

namespace support {

struct GltfNodes {
    std::vector<glm::dmat4> worlds;  ///< from each node to the scene
    std::vector<std::size_t> drawn;  ///< nodes of the scene that is drawn
};

/// Places the nodes of a file: those of the default scene, else of the first scene, else all nodes.
/// Throws InputError where the nodes do not form trees: a node with two parents, or a cycle.
[[nodiscard]] GltfNodes place_gltf_nodes(const GltfFile& file, std::vector<std::string>& notes);

}  // namespace support
