// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene.hpp"

namespace motion {

/// A surface whose triangles share vertices. Seen from outside, corners run counter-clockwise.
struct Shape {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;
};

/// A box around the origin with sides of length 1. `cells` are the squares along each side.
[[nodiscard]] Shape make_box(const glm::ivec3& cells);

/// A closed surface around the y axis. `profile` holds (radius, y) from the top to the bottom; its
/// first and last radius are 0.
[[nodiscard]] Shape make_lathe(std::span<const glm::dvec2> profile, int segments);

/// A square in the plane of x and z around the origin, with sides of length 1, that faces up.
[[nodiscard]] Shape make_square(const glm::ivec2& cells);

/// Adds a shape that goes from one place to another.
void add(Scene& scene, const Shape& shape, const glm::dmat4& begin, const glm::dmat4& end,
         const glm::u8vec4& colour);

/// Adds a shape that stays.
void add(Scene& scene, const Shape& shape, const glm::dmat4& place, const glm::u8vec4& colour);

/// Adds a ground at y = 0 with this centre and size in x and z.
void add_ground(Scene& scene, const glm::dvec2& centre, const glm::dvec2& size,
                const glm::ivec2& cells = glm::ivec2(32));

/// Puts a spot light at `position`. Turns it and narrows its field: its square shadow map just
/// holds all vertices, and its disc holds those that move, without its faded rim. A white surface
/// that faces the light has a radiance of 1 at the distance of `centre`.
void aim_light(Scene& scene, const glm::dvec3& position, const glm::dvec3& centre);

/// Scales the motion of a scene by `exposure`. Where it exceeds 1, the light's field grows with it.
/// Throws InputError where the motion passes the light.
void expose(Scene& scene, double exposure);

/// Replaces a spot light by parallel light along its axis, through a square that just holds all
/// vertices. A white surface that faces it has a radiance of 1.
void make_light_parallel(Scene& scene);

}  // namespace motion
