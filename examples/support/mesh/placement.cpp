// SPDX-License-Identifier: MIT
#include "placement.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "text.hpp"

namespace support {

Placement::Placement(const glm::dmat4& to_scene) : to_scene_(to_scene) {
    const glm::dmat3 m(to_scene);
    mirrors_ = glm::determinant(m) < 0;
    cofactors_ = (mirrors_ ? -1.0 : 1.0) *
                 glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
}

void Placement::add(const glm::dvec3& position, const glm::dvec3& normal, RawMesh& mesh) const {
    const glm::dvec4 placed = to_scene_ * glm::dvec4(position, 1);
    mesh.positions.emplace_back(to_float(placed.x), to_float(placed.y), to_float(placed.z));
    const glm::dvec3 turned = cofactors_ * normal;
    const double length = glm::length(turned);
    mesh.normals.emplace_back(length > 0 && length < 1e300 ? turned / length : glm::dvec3(0));
}

}  // namespace support
