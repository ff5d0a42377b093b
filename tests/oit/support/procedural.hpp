// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "mesh.hpp"

namespace cellist::test {

/// A tube around the (p, q) torus knot: closed, smooth, with many layers. 2 * along * around
/// triangles. Thin enough not to meet itself for p, q up to 3, 7.
inline support::Mesh torus_knot(int p, int q, int along, int around) {
    constexpr double radius = 0.24;
    constexpr double turn = 6.283185307179586;
    const auto centre = [&](double t) {
        const double r = 2 + std::cos(q * t);
        return glm::dvec3(r * std::cos(p * t), r * std::sin(p * t), -std::sin(q * t));
    };
    support::Mesh mesh;
    for (int i = 0; i < along; ++i) {
        const double t = turn * i / along;
        const glm::dvec3 c = centre(t);
        const glm::dvec3 forward = glm::normalize(centre(t + 1e-4) - centre(t - 1e-4));
        const glm::dvec3 side = glm::normalize(glm::cross(forward, c));
        const glm::dvec3 up = glm::cross(side, forward);
        for (int j = 0; j < around; ++j) {
            const double angle = turn * j / around;
            const glm::dvec3 normal = std::cos(angle) * side + std::sin(angle) * up;
            mesh.positions.emplace_back(c + radius * normal);
            mesh.normals.emplace_back(normal);
        }
    }
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(i % along * around + j % around);
    };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    mesh = support::clean_mesh(mesh);
    support::fit_to_unit_sphere(mesh);
    return mesh;
}

}  // namespace cellist::test
