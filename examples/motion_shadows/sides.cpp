// SPDX-License-Identifier: MIT
#include "sides.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>

#include <glm/geometric.hpp>

namespace motion {
namespace {

using Index = std::uint32_t;

// For each vertex, the first vertex with the same positions.
std::vector<Index> welded(const Scene& scene) {
    // Bits have an order even where coordinates are NaN. -0 + 0 is 0.
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0F); };
    const auto way = [&](Index i) {
        const glm::vec3 &a = scene.begin[i], &b = scene.end[i];
        return std::array{bits(a.x), bits(a.y), bits(a.z), bits(b.x), bits(b.y), bits(b.z)};
    };
    std::vector<Index> order(scene.begin.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::sort(order, [&](Index i, Index j) {
        const auto a = way(i), b = way(j);
        return a != b ? a < b : i < j;
    });
    std::vector<Index> first(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first[order[k]] =
            k > 0 && way(order[k]) == way(order[k - 1]) ? first[order[k - 1]] : order[k];
    return first;
}

// Disjoint sets of vertices.
class Sets {
public:
    explicit Sets(std::size_t size) : parent_(size) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index find(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Index i, Index j) { parent_[find(i)] = find(j); }

private:
    std::vector<Index> parent_;
};

// Whether the set that a vertex represents has an edge without its opposite.
std::vector<bool> open_surfaces(const std::vector<glm::uvec3>& triangles, Sets& sets,
                                std::size_t vertices) {
    struct Edge {
        Index low, high;
        int direction;
    };
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (const glm::uvec3& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const Index i = t[k], j = t[(k + 1) % 3];
            edges.push_back({std::min(i, j), std::max(i, j), i < j ? 1 : -1});
        }
    std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    std::vector<bool> is_open(vertices);
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin;
        int sum = 0;
        for (; end < edges.size() && edges[end].low == edges[begin].low &&
               edges[end].high == edges[begin].high;
             ++end)
            sum += edges[end].direction;
        if (end - begin != 2 || sum != 0) is_open[sets.find(edges[begin].low)] = true;
        begin = end;
    }
    return is_open;
}

}  // namespace

std::vector<cl_uchar> seen_sides(const Scene& scene, const View& view) {
    const std::vector<Index> first = welded(scene);
    std::vector<glm::uvec3> triangles;
    triangles.reserve(scene.triangles.size());
    Sets sets(first.size());
    for (const glm::uvec3& t : scene.triangles) {
        triangles.emplace_back(first[t.x], first[t.y], first[t.z]);
        sets.join(triangles.back().x, triangles.back().y);
        sets.join(triangles.back().y, triangles.back().z);
    }
    std::vector<bool> is_open = open_surfaces(triangles, sets, first.size());

    const auto depth = [&](const glm::vec3& p) {
        const cl_float* row = view.row_depth.s;
        return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
    };
    for (Index i = 0; i < first.size(); ++i)
        if (!(std::min(depth(scene.begin[i]), depth(scene.end[i])) >= view.near_depth))
            is_open[sets.find(first[i])] = true;

    // The volume of a surface is a cubic in t; these are its coefficients in the Bernstein basis.
    std::vector<std::array<double, 4>> volumes(first.size());
    for (const glm::uvec3& t : triangles) {
        glm::dvec3 p[3][2];
        for (int k = 0; k < 3; ++k) {
            p[k][0] = scene.begin[t[k]];
            p[k][1] = scene.end[t[k]];
        }
        std::array<double, 4>& volume = volumes[sets.find(t.x)];
        for (int which = 0; which < 8; ++which) {
            const int x = which & 1, y = which >> 1 & 1, z = which >> 2 & 1;
            volume[static_cast<std::size_t>(x + y + z)] +=
                glm::dot(p[0][x], glm::cross(p[1][y], p[2][z]));
        }
    }
    std::vector<cl_uchar> sides;
    sides.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        const Index surface = sets.find(t.x);
        const auto [least, most] = std::ranges::minmax(volumes[surface]);
        const bool is_outward = least > 0, is_inward = most < 0;
        sides.push_back(is_open[surface] || !(is_outward || is_inward) ? both_sides
                        : is_outward                                   ? side_front
                                                                       : side_back);
    }
    return sides;
}

}  // namespace motion
