// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "frame.hpp"
#include "scene.hpp"

namespace cellist::test {

inline constexpr double pi = std::numbers::pi;

/// A square across the z axis, in the plane z = `height`.
inline support::Mesh square(double height, double half_side) {
    support::Mesh mesh;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.positions.emplace_back(half_side * x, half_side * y, height);
    mesh.normals.assign(4, glm::vec3(0, 0, 1));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A spot light at the origin shines along -z on a square, whose light falls on another square at
/// z = `distance` - 1. The eye sees only the second square. Between them is room for a wall that
/// blocks everything.
inline shadows::Scene facing_squares(double distance, bool has_wall) {
    shadows::Scene scene;
    scene.meshes = {square(-1, 20), square(distance - 1, 20)};
    scene.instances = {{.mesh = 0, .albedo = {0.5F, 0.25F, 1}}, {.mesh = 1, .albedo = {1, 1, 1}}};
    if (has_wall) {
        scene.meshes.push_back(square(0.2, 100));
        scene.instances.push_back({.mesh = 2, .blocks = true});
    }
    scene.light = {
        .position = {0, 0, 0}, .target = {0, 0, -1}, .field_degrees = 60, .intensity = {3, 3, 3}};
    scene.eye = {0, 0, 0.5};
    scene.target = {0, 0, distance - 1};
    scene.field_degrees = 60;
    return scene;
}

/// The smallest settings of a picture: everything at full resolution.
inline shadows::Settings small_settings(int width, int height, int samples) {
    return {.width = width,
            .height = height,
            .rsm = 64,
            .samples = samples,
            .reduce = 1,
            .interleave = 1};
}

inline double channel_of(const cl_float4& pixel, int channel) {
    return static_cast<double>(pixel.s[channel]);
}

/// Whether two numbers differ by at most `error` of the second.
inline bool is_close(double is, double should, double error) {
    return std::abs(is - should) <= error * std::abs(should);
}

}  // namespace cellist::test
