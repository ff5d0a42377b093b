// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "light.hpp"
#include "mesh.hpp"

namespace motion {

/// A moving scene, in metres. Each vertex moves on a straight line, from `begin` at t = 0 to `end`
/// at t = 1. The triangles of the ground come first.
struct Scene {
    std::string name;
    std::vector<glm::vec3> begin, end;  ///< positions of the vertices
    std::vector<glm::uvec3> triangles;  ///< indices of vertices; both sides are drawn
    std::vector<glm::u8vec4> colours;   ///< of the triangles: sRGB, and 255
    support::Light light;
    glm::dvec3 eye{0, 1, 4}, target{0};
    double field_degrees = 40;
};

/// Two cubes that move up towards a light, over a ground: 12,000 triangles, as in Figure 9.
[[nodiscard]] Scene make_cubes();

/// A person who walks towards a light, as in Figure 10. One leg swings forward, the other foot
/// stands still. Has `triangles` triangles, to within 1 %. Throws InputError unless `triangles` is
/// from 12,000 to 1,000,000.
[[nodiscard]] Scene make_walker(std::size_t triangles = 265'000);

/// A fast fan over a ground, so that a texel of the shadow map sees many triangles.
[[nodiscard]] Scene make_fan();

/// Two rows of slats in front of a wall. The front row moves sideways, and the rear row moves up
/// through the shadows of the front row.
[[nodiscard]] Scene make_blinds();

/// A turn about the vertical through the centre, then a translation.
struct RigidMotion {
    glm::dvec3 move{0};  ///< in metres
    double spin_degrees = 0;
};

/// A mesh over a ground. Scales the mesh so that its largest side is 1 m. Throws InputError where
/// the mesh has no triangle or no size, or where it moves too far.
[[nodiscard]] Scene make_mesh_scene(const support::Mesh& mesh, const RigidMotion& motion);

}  // namespace motion
