// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>

#include "gltf_accessor.hpp"
#include "gltf_file.hpp"

namespace support {

/// The matrices of a skin's joints, from the mesh in its bind pose to the scene.
[[nodiscard]] std::vector<glm::dmat4> place_gltf_joints(GltfFile& file, const GltfValue& skin,
                                                        const std::vector<glm::dmat4>& nodes);

/// How joints move the vertices of a primitive, by its attributes JOINTS_n and WEIGHTS_n.
class GltfSkin {
public:
    /// `joints` must outlive the object.
    GltfSkin(GltfFile& file, const std::vector<glm::dmat4>& joints, const GltfValue& attributes,
             std::size_t vertices);

    /// From the mesh to the scene. A vertex without weights follows its first joint.
    [[nodiscard]] glm::dmat4 matrix_of(std::size_t vertex) const;

private:
    struct Influences {
        GltfAccessor joints, weights;
    };

    const std::vector<glm::dmat4>& joints_;
    std::vector<Influences> influences_;
};

}  // namespace support
