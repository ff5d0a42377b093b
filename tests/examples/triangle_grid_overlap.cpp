// SPDX-License-Identifier: MIT
// Triangles are in the list of every cell that they touch, and of few others.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cellist/cellist.hpp>

#include "examples/triangle_grid.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using Corners = std::array<glm::dvec3, 3>;

glm::dvec3 in_cells(const grid::GridCells& cells, const glm::vec3& place) {
    glm::dvec3 result(place);
    for (int k = 0; k < 3; ++k)
        result[k] = (result[k] - static_cast<double>(cells.origin[k])) / grid::cell_side(cells);
    return result;
}

// Whether a plane across the axis separates the triangle from the cube of side 1 at 0.
bool separates(const glm::dvec3& axis, const Corners& triangle) {
    const double p = glm::dot(axis, triangle[0]), q = glm::dot(axis, triangle[1]),
                 r = glm::dot(axis, triangle[2]);
    const glm::dvec3 low = glm::min(axis, glm::dvec3(0)), high = glm::max(axis, glm::dvec3(0));
    // What rounding could decide is not counted.
    const double slack = 1e-9 * (std::abs(p) + std::abs(q) + std::abs(r));
    return std::min({p, q, r}) > high.x + high.y + high.z - slack ||
           std::max({p, q, r}) < low.x + low.y + low.z + slack;
}

bool touches(Corners triangle, const glm::dvec3& cell) {
    for (glm::dvec3& corner : triangle) corner -= cell;
    const glm::dvec3 edges[3] = {triangle[1] - triangle[0], triangle[2] - triangle[1],
                                 triangle[0] - triangle[2]};
    if (separates(glm::cross(edges[0], edges[1]), triangle)) return false;
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 axis(0);
        axis[k] = 1;
        if (separates(axis, triangle)) return false;
        for (const glm::dvec3& edge : edges)
            if (glm::dot(edge, edge) > 0 && separates(glm::cross(axis, edge), triangle))
                return false;
    }
    return true;
}

// Triangles of a size around random places in the unit cube, with two corners that are `width`
// times as far apart as the third.
Triangles random_triangles(int count, float size, float width, std::mt19937& random) {
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    const auto point = [&] { return glm::vec3(normal(random), normal(random), normal(random)); };
    Triangles triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 centre(uniform(random), uniform(random), uniform(random));
        const glm::vec3 a = centre + size * point();
        triangles.push_back({a, a + size * width * point(), centre + size * point()});
    }
    return triangles;
}

struct Entries {
    std::size_t missing = 0, listed = 0, needed = 0;
};

Entries compare(const Triangles& triangles, const grid::GridCells& cells) {
    grid::TriangleGrid grid(device(), triangles, cells);
    grid.build();
    const HostLists<cl_uint> lists = grid.entries().download();
    const glm::ivec3 extent(cells.extent[0], cells.extent[1], cells.extent[2]);
    const glm::ivec3 bricks = (extent + 3) / 4;
    std::vector<Corners> corners;
    for (const GridTriangle& triangle : triangles)
        corners.push_back({in_cells(cells, triangle.a), in_cells(cells, triangle.b),
                           in_cells(cells, triangle.c)});
    Entries entries;
    for (int z = 0; z < extent.z; ++z)
        for (int y = 0; y < extent.y; ++y)
            for (int x = 0; x < extent.x; ++x) {
                const int brick = (z / 4 * bricks.y + y / 4) * bricks.x + x / 4;
                const auto list = lists.cell(
                    static_cast<std::uint64_t>(brick * 64 + x % 4 + y % 4 * 4 + z % 4 * 16));
                std::vector<bool> is_listed(triangles.size());
                for (const cl_uint triangle : list) is_listed[triangle] = true;
                for (std::size_t i = 0; i < triangles.size(); ++i) {
                    const bool is_needed = touches(corners[i], glm::dvec3(x, y, z));
                    if (is_needed && !is_listed[i]) ++entries.missing;
                    if (is_needed) ++entries.needed;
                    if (is_listed[i]) ++entries.listed;
                }
            }
    return entries;
}

TEST_CASE("triangles of every shape and size are in the lists of the cells that they touch") {
    std::mt19937 random(17);
    const grid::GridCells cells = grid::cells_in_box(glm::dvec3(0), glm::dvec3(1, 0.9, 0.7), 20, 0);
    for (const float size : {1e-4F, 0.02F, 0.3F, 3.0F, 1e3F, 1e6F, 1e12F})
        for (const float width : {1.0F, 1e-2F, 1e-5F, 1e-7F, 0.0F}) {
            const Triangles triangles = random_triangles(60, size, width, random);
            const Entries entries = compare(triangles, cells);
            INFO("size " << size << ", width " << width << ": " << entries.needed << " needed, "
                         << entries.listed << " listed");
            CHECK(entries.missing == 0);
            // The margin of 2^-8 of a cell.
            if (size <= 1e6F && device().info().fp64)
                CHECK(static_cast<double>(entries.listed) <=
                      1.05 * static_cast<double>(entries.needed) + 8);
        }
}

TEST_CASE("triangles in the faces of cells are in the lists of both sides") {
    // Multiples of a cell, exactly.
    const grid::GridCells cells = grid::cells_in_box(glm::dvec3(0), glm::dvec3(8), 8, 0);
    std::mt19937 random(3);
    Triangles triangles;
    for (int i = 0; i < 90; ++i) {
        GridTriangle triangle{};
        for (glm::vec3* corner : {&triangle.a, &triangle.b, &triangle.c}) {
            for (int k = 0; k < 3; ++k) (*corner)[k] = static_cast<float>(random() % 9);
            if (i % 3 == 0) corner->x = 4;
            if (i % 3 == 1) corner->y = corner->x;
        }
        triangles.push_back(triangle);
    }
    CHECK(compare(triangles, cells).missing == 0);
}

}  // namespace
}  // namespace cellist::test
