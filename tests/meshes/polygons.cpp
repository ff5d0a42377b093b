// SPDX-License-Identifier: MIT
// Polygons of any shape are split into triangles that cover exactly their inside.
#include <random>

#include "mesh/polygon.hpp"
#include "meshes/support/plain.hpp"
#include "oit/support/files.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

using Result = support::PolygonSplitter::Result;

struct Split {
    Result result = Result::flat;
    std::size_t triangles = 0;
    double signed_area = 0;  // along the polygon's normal
    double least_area = 1e30;
};

std::vector<glm::dvec3> doubles(const std::vector<glm::vec3>& corners) {
    return {corners.begin(), corners.end()};
}

Split split(const std::vector<glm::vec3>& corners) {
    std::vector<support::PolygonSplitter::Triangle> triangles;
    Split split;
    split.result = support::PolygonSplitter().split(corners, triangles);
    split.triangles = triangles.size();
    const glm::dvec3 whole = area_vector(doubles(corners));
    for (const auto& t : triangles) {
        const double area =
            glm::dot(area_vector(doubles({corners[t[0]], corners[t[1]], corners[t[2]]})),
                     glm::length(whole) > 0 ? glm::normalize(whole) : glm::dvec3(0));
        split.signed_area += area;
        split.least_area = std::min(split.least_area, area);
    }
    return split;
}

void check_covered(const std::vector<glm::vec3>& corners, std::size_t triangles) {
    const Split found = split(corners);
    CHECK(found.result == Result::split);
    CHECK(found.triangles == triangles);
    CHECK(found.least_area > 0);
    const double area = glm::length(area_vector(doubles(corners)));
    CHECK(std::abs(found.signed_area - area) <= 1e-9 * area);
}

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// A polygon of random corners on a lattice; crossing edges are exchanged until none cross. Empty
// where three corners are collinear, since the polygon may then touch itself.
std::vector<glm::vec3> simple_polygon(std::mt19937& random, std::size_t count) {
    std::vector<glm::dvec2> p;
    for (std::size_t i = 0; i < count; ++i) p.emplace_back(random() % 1000, random() % 1000);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count; ++j)
            for (std::size_t k = j + 1; k < count; ++k)
                if (turn(p[i], p[j], p[k]) == 0) return {};
    const auto crosses = [&](std::size_t i, std::size_t j) {
        const auto &a = p[i], &b = p[i + 1], &c = p[j], &d = p[(j + 1) % count];
        return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i + 2 < count; ++i)
            for (std::size_t j = i + 2; j < count; ++j)
                if (crosses(i, j)) {
                    std::reverse(p.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                 p.begin() + static_cast<std::ptrdiff_t>(j) + 1);
                    changed = true;
                }
    }
    std::vector<glm::vec3> corners;
    for (const auto& q : p) corners.emplace_back(q.x, q.y, q.x - 2 * q.y);
    return corners;
}

TEST_CASE("random simple polygons of 4 to 30 corners are covered") {
    std::mt19937 random(7);
    int checked = 0;
    for (int i = 0; i < 600; ++i) {
        const auto corners = simple_polygon(random, 4 + random() % (i % 4 == 0 ? 27 : 5));
        if (corners.empty()) continue;
        ++checked;
        INFO("polygon " << i);
        check_covered(corners, corners.size() - 2);
        check_covered({corners.rbegin(), corners.rend()}, corners.size() - 2);
    }
    CHECK(checked > 500);
}

TEST_CASE("concave quads are split along the diagonal that lies within") {
    check_covered({{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {2, 4, 0}}, 2);
    check_covered({{2, 1, 0}, {4, 0, 0}, {2, 4, 0}, {0, 0, 0}}, 2);
}

TEST_CASE("collinear corners stay corners of triangles") {
    check_covered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 1, 0}}, 3);
    check_covered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}}, 4);
}

TEST_CASE("polygons that touch themselves are covered") {
    // A square with a hole, joined by an edge that is used twice; and two triangles that touch.
    const auto hole = split({{0, 0, 0},
                             {4, 0, 0},
                             {4, 4, 0},
                             {0, 4, 0},
                             {0, 0, 0},
                             {1, 1, 0},
                             {1, 3, 0},
                             {3, 3, 0},
                             {3, 1, 0},
                             {1, 1, 0}});
    CHECK(hole.result == Result::split);
    CHECK(hole.signed_area == 12);
    CHECK(hole.least_area > 0);
    const auto touching = split({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}});
    CHECK(touching.result == Result::split);
    CHECK(touching.signed_area == 8);
    CHECK(touching.least_area > 0);
}

TEST_CASE("equal neighbours and spikes are left out, polygons without area are flat") {
    check_covered({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}}, 1);
    check_covered({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 1);
    CHECK(split({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).result == Result::flat);
    CHECK(split({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).result == Result::flat);
}

TEST_CASE("polygons that cross themselves are not split") {
    CHECK(split({{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}}).result == Result::crossing);
    std::vector<glm::vec3> star;
    for (int i = 0; i < 5; ++i) {
        const double angle = 2 * 6.283185307179586 * i / 5;
        star.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    CHECK(split(star).result == Result::crossing);
}

TEST_CASE("coordinates of 1e-30 and of 1e31 are safe") {
    for (const float scale : {1e-30F, 1e31F}) {
        INFO("scale " << scale);
        const auto arrow = split({scale * glm::vec3(0, 0, 1), scale * glm::vec3(2, 1, 1),
                                  scale * glm::vec3(4, 0, 1), scale * glm::vec3(2, 4, 1)});
        CHECK(arrow.result == Result::split);
        CHECK(arrow.triangles == 2);
    }
}

TEST_CASE("a star and a spiral of 600,000 corners are split") {
    constexpr int count = 600'000;
    std::vector<glm::vec3> star, spiral;
    for (int i = 0; i < count; ++i) {
        const double angle = 6.283185307179586 * i / count, radius = i % 2 == 0 ? 1 : 0.5;
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        const int step = i < count / 2 ? i : count - 1 - i;
        const double turns = 600.0 * step / count;
        const double distance = 1 + turns + (i < count / 2 ? 0 : 0.1);
        spiral.emplace_back(distance * std::cos(turns), distance * std::sin(turns), 0);
    }
    CHECK(split(star).triangles == count - 2);
    CHECK(split(spiral).triangles == count - 2);
}

TEST_CASE("what does not split is dropped whole and counted") {
    const Folder folder;
    const support::Mesh mesh = support::load_mesh(
        folder.write("p.off",
                     "OFF\n8 5 0\n0 0 0\n3 3 0\n3 0 0\n0 2 0\n1 1 5\n2 2 5\n3 3 5\nnan 0 0\n"
                     "3 0 1 2\n4 0 1 2 3\n4 4 5 6 4\n4 0 1 2 7\n4 0 1 2 99\n"));
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.positions.size() == 3);
    CHECK(mesh.drops.unsplit_polygons == 1);
    CHECK(mesh.drops.degenerate_triangles == 1);
    CHECK(mesh.drops.nonfinite_triangles == 1);
    CHECK(mesh.drops.out_of_range_triangles == 1);
}

}  // namespace
}  // namespace cellist::test
