// SPDX-License-Identifier: MIT
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "raw_mesh.hpp"

namespace support {

/// Takes vertices from a mesh of a file to the file's scene.
class Placement {
public:
    explicit Placement(const glm::dmat4& to_scene);

    /// Whether triangles change their orientation.
    [[nodiscard]] bool mirrors() const { return mirrors_; }
    /// Adds a vertex to the mesh. A normal of 0, or one that the transform makes 0, stays 0.
    void add(const glm::dvec3& position, const glm::dvec3& normal, RawMesh& mesh) const;

private:
    glm::dmat4 to_scene_;
    /// Transforms normals. Unlike the inverse, it is finite for singular and tiny transforms.
    glm::dmat3 cofactors_;
    bool mirrors_;
};

}  // namespace support
