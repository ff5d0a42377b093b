// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "mesh.hpp"

namespace cellist::test {

/// The mesh that a file describes: the oracle of the tests. Coordinates are multiples of 1/64, so
/// that few decimals and every floating-point type hold them exactly.
struct PlainMesh {
    std::vector<glm::dvec3> positions;
    std::vector<std::vector<std::uint32_t>> faces;

    [[nodiscard]] bool has_triangles_only() const {
        return std::all_of(faces.begin(), faces.end(), [](const auto& f) { return f.size() == 3; });
    }
};

inline glm::dvec3 snapped(const glm::dvec3& p) {
    return {std::round(p.x * 64) / 64, std::round(p.y * 64) / 64, std::round(p.z * 64) / 64};
}

/// An icosahedron whose triangles are split into four: 42 vertices, 80 triangles.
inline PlainMesh icosphere() {
    const double g = (1 + std::sqrt(5.0)) / 2;
    PlainMesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    constexpr std::uint32_t corners[20][3] = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, is_new] = middles.try_emplace(
            {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2.0);
        return entry->second;
    };
    for (const auto& t : corners) {
        const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
        mesh.faces.insert(mesh.faces.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    for (glm::dvec3& p : mesh.positions) p = snapped(glm::normalize(p));
    return mesh;
}

/// A sheared prism with the outline of a comb: two concave polygons of 14 corners, and 14 quads;
/// and an arrowhead, a concave quad, above it.
inline PlainMesh comb_prism() {
    constexpr int outline[14][2] = {{0, 0}, {7, 0}, {7, 4}, {6, 4}, {6, 1}, {5, 1}, {5, 3},
                                    {4, 3}, {4, 1}, {3, 1}, {2, 4}, {2, 1}, {1, 1}, {1, 2}};
    PlainMesh mesh;
    for (const double z : {0.0, 1.0})
        for (const auto& p : outline)
            mesh.positions.emplace_back(p[0] + z / 2, p[1] + p[0] / 4.0, z + p[0] / 8.0);
    std::vector<std::uint32_t> bottom, top;
    for (std::uint32_t i = 0; i < 14; ++i) {
        top.push_back(14 + i);
        bottom.push_back(13 - i);
        const std::uint32_t next = (i + 1) % 14;
        mesh.faces.push_back({i, next, 14 + next, 14 + i});
    }
    mesh.faces.push_back(top);
    mesh.faces.push_back(bottom);
    for (const glm::dvec3& p :
         {glm::dvec3(0, 0, 3), glm::dvec3(2, 1, 3), glm::dvec3(4, 0, 3), glm::dvec3(2, 4, 3)})
        mesh.positions.push_back(p);
    mesh.faces.push_back({28, 29, 30, 31});
    return mesh;
}

using PlacedTriangle = std::array<std::array<float, 3>, 3>;

inline std::array<float, 3> placed(const glm::vec3& p) {
    return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
}

/// Starts at the least corner and keeps the winding.
inline PlacedTriangle rotated(PlacedTriangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

inline std::vector<PlacedTriangle> triangles_of(const support::Mesh& mesh) {
    std::vector<PlacedTriangle> triangles;
    for (const auto& t : mesh.triangles)
        triangles.push_back(rotated({placed(mesh.positions[t[0]]), placed(mesh.positions[t[1]]),
                                     placed(mesh.positions[t[2]])}));
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

inline glm::dvec3 area_vector(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 sum(0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return 0.5 * sum;
}

/// Whether a point of a polygon's plane lies in it: crossings of a ray, in the coordinate plane
/// that keeps most of its area.
inline bool lies_in(const glm::dvec3& point, const std::vector<glm::dvec3>& corners) {
    const glm::dvec3 normal = area_vector(corners);
    if (std::abs(glm::dot(normal, point - corners[0])) > 1e-9 * glm::dot(normal, normal))
        return false;
    const glm::dvec3 size = glm::abs(normal);
    const int u = size.x >= std::max(size.y, size.z) ? 1 : 0;
    const int v = size.z > std::max(size.x, size.y) ? 1 : 2;
    bool inside = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
        if ((a[v] > point[v]) != (b[v] > point[v]) &&
            point[u] < a[u] + (point[v] - a[v]) / (b[v] - a[v]) * (b[u] - a[u]))
            inside = !inside;
    }
    return inside;
}

/// Says how a loaded mesh differs from the plain one; empty if it does not. Compares triangles with
/// their winding. Each polygon must be covered by triangles that lie within it and have its area.
inline std::string difference(const support::Mesh& loaded, const PlainMesh& plain) {
    if (plain.has_triangles_only()) {
        std::vector<PlacedTriangle> expected;
        for (const auto& f : plain.faces) {
            const auto& p = plain.positions;
            expected.push_back(rotated({placed(p[f[0]]), placed(p[f[1]]), placed(p[f[2]])}));
        }
        std::sort(expected.begin(), expected.end());
        const auto found = triangles_of(loaded);
        if (found.size() != expected.size())
            return std::to_string(found.size()) + " triangles, not " +
                   std::to_string(expected.size());
        return found == expected ? "" : "triangles at other places";
    }
    std::vector<double> covered(plain.faces.size(), 0);
    for (const auto& t : loaded.triangles) {
        const std::vector<glm::dvec3> corners{loaded.positions[t[0]], loaded.positions[t[1]],
                                              loaded.positions[t[2]]};
        const glm::dvec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        bool found = false;
        for (std::size_t f = 0; f < plain.faces.size() && !found; ++f) {
            std::vector<glm::dvec3> face;
            for (const std::uint32_t v : plain.faces[f]) face.push_back(plain.positions[v]);
            const bool has_corners =
                std::all_of(corners.begin(), corners.end(), [&](const auto& c) {
                    return std::find(face.begin(), face.end(), c) != face.end();
                });
            if (!has_corners || !lies_in(centre, face)) continue;
            found = true;
            if (glm::dot(area_vector(corners), area_vector(face)) <= 0)
                return "a triangle turned round";
            covered[f] += glm::length(area_vector(corners));
        }
        if (!found) return "a triangle outside of all polygons";
    }
    for (std::size_t f = 0; f < plain.faces.size(); ++f) {
        std::vector<glm::dvec3> face;
        for (const std::uint32_t v : plain.faces[f]) face.push_back(plain.positions[v]);
        const double area = glm::length(area_vector(face));
        if (std::abs(covered[f] - area) > 1e-6 * area)
            return "polygon " + std::to_string(f) + " covered by " + std::to_string(covered[f]) +
                   " of its area of " + std::to_string(area);
    }
    return "";
}

}  // namespace cellist::test
