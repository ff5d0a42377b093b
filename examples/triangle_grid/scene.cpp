// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

namespace triangle_grid {

support::Mesh make_knot() {
    constexpr int along = 512, around = 48;
    constexpr double turn = 2 * std::numbers::pi, radius = 0.32;
    const auto centre = [](double t) {
        const double r = 2 + std::cos(3 * t);
        return glm::dvec3(r * std::cos(2 * t), r * std::sin(2 * t), -std::sin(3 * t));
    };
    support::Mesh mesh;
    for (int i = 0; i < along; ++i) {
        const double t = turn * i / along;
        const glm::dvec3 forward = glm::normalize(centre(t + 1e-4) - centre(t - 1e-4));
        const glm::dvec3 across = glm::normalize(glm::cross(forward, centre(t)));
        const glm::dvec3 up = glm::cross(across, forward);
        for (int j = 0; j < around; ++j) {
            const double angle = turn * j / around;
            const glm::dvec3 normal = std::cos(angle) * across + std::sin(angle) * up;
            mesh.positions.emplace_back(centre(t) + radius * normal);
            mesh.normals.emplace_back(normal);
        }
    }
    const auto index = [](int i, int j) {
        return static_cast<std::uint32_t>(i % along * around + j % around);
    };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    support::fit_to_unit_sphere(mesh);
    return mesh;
}

std::vector<grid::GridTriangle> triangles_of(const support::Mesh& mesh) {
    std::vector<grid::GridTriangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles)
        triangles.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    return triangles;
}

}  // namespace triangle_grid
