// SPDX-License-Identifier: MIT
// Asking a grid gives the same answers as asking every triangle.
#include "examples/triangle_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include <cellist/cellist.hpp>

#include "grid/exact.hpp"
#include "scene.hpp"
#include "segments.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

// Where the line of a segment meets a triangle's plane, in double.
struct Meeting {
    double at, u, v;
    double condition;  // what multiplies roundings of the input in u and v
};

Meeting meeting_of(const Segment& segment, const GridTriangle& triangle) {
    const glm::dvec3 from(segment.from), direction = glm::dvec3(segment.to) - from;
    const glm::dvec3 a(triangle.a), ab = glm::dvec3(triangle.b) - a,
                                    ac = glm::dvec3(triangle.c) - a;
    const glm::dvec3 normal = glm::cross(ab, ac), moment = glm::cross(from - a, direction);
    const double slope = glm::dot(normal, direction);
    const double size = glm::length(ab) + glm::length(ac);
    return {-glm::dot(normal, from - a) / slope, -glm::dot(ac, moment) / slope,
            glm::dot(ab, moment) / slope,
            size * (glm::length(from - a) + size) * glm::length(direction) / std::abs(slope)};
}

}  // namespace

GridAnswers ask(grid::TriangleGrid& grid, const std::vector<Segment>& segments) {
    grid.build();
    REQUIRE(grid.entries().validate().ok());
    grid::Rays rays(device(), grid);
    const Buffer<grid::GridSegment> asked(device(), triangle_grid::to_device(segments));
    Buffer<cl_uint> any(device(), segments.size());
    any.fill(7);
    rays.any_hits(asked, asked.size(), any);
    const std::uint32_t invalid = rays.invalid();
    Buffer<grid::GridHit> closest(device(), segments.size());
    rays.closest_hits(asked, asked.size(), closest);
    CHECK(rays.invalid() == invalid);
    return {any.download(), closest.download(), invalid};
}

GridAnswers ask(const Triangles& triangles, const grid::GridCells& cells,
                const std::vector<Segment>& segments, Storage storage) {
    grid::TriangleGrid grid(device(), triangles, cells, storage);
    return ask(grid, segments);
}

void require_right(const Triangles& triangles, const std::vector<Segment>& segments,
                   const GridAnswers& answers) {
    if (!device().info().fp64) CELLIST_SKIP("exact answers: the device has no doubles");
    std::size_t wrong_any = 0, wrong_closest = 0, too_far = 0, wrong_distance = 0;
    std::size_t wrong_weights = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        const grid::GridHit& hit = answers.closest[i];
        bool is_met = false, is_any = false;
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            if (!grid::meets_any(segments[i].from, segments[i].to, {&triangles[k], 1})) continue;
            is_any = true;
            nearest = std::fmin(nearest, meeting_of(segments[i], triangles[k]).at);
            is_met = is_met || k == hit.triangle;
        }
        if (answers.any[i] != (is_any ? 1U : 0U)) ++wrong_any;
        if (is_any != is_met || (hit.triangle == grid::GridHit::none) == is_any) ++wrong_closest;
        if (!is_met) continue;
        const Meeting meeting = meeting_of(segments[i], triangles[hit.triangle]);
        // Rounding in double decides where the segment nearly lies in the plane.
        if (!(meeting.condition < 1e9)) continue;
        if (!(meeting.at <= nearest + 0x1p-12)) ++too_far;
        if (!(std::abs(static_cast<double>(hit.at) - meeting.at) < 1e-6)) ++wrong_distance;
        if (!(std::abs(static_cast<double>(hit.u) - meeting.u) < 1e-6 &&
              std::abs(static_cast<double>(hit.v) - meeting.v) < 1e-6))
            ++wrong_weights;
    }
    CHECK(wrong_any == 0);
    CHECK(wrong_closest == 0);
    CHECK(too_far == 0);
    CHECK(wrong_distance == 0);
    CHECK(wrong_weights == 0);
}

void require_same(const Triangles& triangles, const grid::GridCells& cells,
                  const std::vector<Segment>& segments) {
    for (const Storage storage : {Storage::linked, Storage::counted})
        require_right(triangles, segments, ask(triangles, cells, segments, storage));
}

void require_same(const Triangles& triangles, int longest, std::size_t segments) {
    const grid::GridCells cells = grid::cells_around(triangles, longest);
    require_same(triangles, cells, triangle_grid::make_segments(segments, cells, triangles, 3));
}

Triangles sheet(int n, float height) {
    Triangles triangles;
    const auto corner = [&](int x, int y) {
        return glm::vec3(static_cast<float>(x), static_cast<float>(y), height);
    };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            triangles.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
            triangles.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
        }
    return triangles;
}

Triangles part_of_knot(std::size_t step) {
    const Triangles knot = triangle_grid::triangles_of(triangle_grid::make_knot());
    Triangles part;
    for (std::size_t i = 0; i < knot.size(); i += step) part.push_back(knot[i]);
    return part;
}

namespace {

TEST_CASE("grids of every size") {
    Triangles some = part_of_knot();
    triangle_grid::add_flat_triangles(some);
    for (const int longest : {1, 2, 3, 31, 128}) require_same(some, longest);
}

TEST_CASE("triangles of all sizes, much larger and much smaller than a cell") {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    Triangles triangles;
    for (int i = 0; i < 400; ++i) {
        const float size = std::pow(10.0F, static_cast<float>(i % 8) - 6.0F);
        const auto point = [&] {
            return glm::vec3(normal(random), normal(random), normal(random));
        };
        const glm::vec3 centre = point();
        triangles.push_back(
            {centre + size * point(), centre + size * point(), centre + size * point()});
    }
    for (const int longest : {1, 40}) require_same(triangles, longest);
}

TEST_CASE("nothing passes between triangles that share edges and corners") {
    const int n = 16;
    const Triangles triangles = sheet(n, 3);
    const grid::GridCells cells = grid::cells_around(triangles, n);
    std::vector<Segment> segments;
    for (int i = 0; i <= 2 * n; ++i)
        for (int j = 0; j <= 2 * n; ++j) {
            const glm::vec3 target(0.5F * static_cast<float>(i), 0.5F * static_cast<float>(j), 3);
            for (const glm::vec3& along :
                 {glm::vec3(0, 0, 1), glm::vec3(0.25F, 0, 1), glm::vec3(0.5F, -0.75F, 2),
                  glm::vec3(1000, -3000, 0.5F), glm::vec3(0, 0, 1e6F)})
                segments.push_back({target - along, target + along});
        }
    for (const cl_uint hit : ask(triangles, cells, segments, Storage::counted).any)
        REQUIRE(hit == 1);
    require_same(triangles, cells, segments);
}

TEST_CASE("segments that end at a triangle, in its plane, or before it") {
    const Triangles triangles = sheet(1, 0);
    const auto hits = [&](glm::vec3 from, glm::vec3 to) {
        return ask(triangles, grid::cells_around(triangles, 4), {{from, to}}, Storage::linked)
            .any[0];
    };
    CHECK(hits({0.25F, 0.5F, 1}, {0.25F, 0.5F, 0}) == 1);
    CHECK(hits({0.25F, 0.5F, 0}, {0.25F, 0.5F, -1}) == 1);
    CHECK(hits({0.25F, 0.5F, 1}, {0.25F, 0.5F, 1e-30F}) == 0);
    CHECK(hits({1, 1, 1}, {1, 1, 0}) == 1);
    CHECK(hits({-1, 0.5F, 0}, {2, 0.5F, 0}) == 0);
    CHECK(hits({0.5F, 0.25F, 0}, {0.5F, 0.25F, 0}) == 0);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    CHECK(hits({nan, 0.5F, 1}, {0.25F, 0.5F, -1}) == 0);
    CHECK(hits({0.25F, 0.5F, infinity}, {0.25F, 0.5F, -1}) == 0);
    CHECK(hits({0.25F, 0.5F, 3e38F}, {0.25F, 0.5F, -3e38F}) == 1);
}

TEST_CASE("segments whose ends are as far away as floats go") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const float scale : {1e-31F, 1.0F, 1e31F}) {
        Triangles triangles = triangle_grid::triangles_of(triangle_grid::make_knot());
        triangles.resize(600);
        for (GridTriangle& t : triangles)
            for (glm::vec3* corner : {&t.a, &t.b, &t.c}) *corner *= scale;
        const auto point = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
        const auto in_mesh = [&] {
            const GridTriangle& t = triangles[random() % triangles.size()];
            return (t.a + t.b + t.c) / 3.0F;
        };
        std::vector<Segment> segments;
        for (int exponent = 45; exponent < 127; ++exponent)
            for (int i = 0; i < 12; ++i) {
                glm::vec3 far = std::ldexp(1.0F, exponent) * point();
                if (i % 4 == 1) far[i % 3] = in_mesh()[i % 3];
                if (i % 4 == 2)
                    far = std::ldexp(1.0F, exponent) * glm::vec3(glm::ivec3(2.0F * point()));
                const glm::vec3 through = in_mesh();
                // One end near, and both ends far: through the mesh exactly where floats can say
                // so.
                segments.push_back({far, through - 0.25F * scale * glm::normalize(point())});
                segments.push_back({i % 2 == 0 ? -far : 2.0F * through - far, far});
            }
        INFO(scale);
        require_same(triangles, grid::cells_around(triangles, 32), segments);
    }
}

TEST_CASE("a far end does not change the answer near the mesh") {
    // Towards a square from every distance: the exact answer is known by construction.
    const Triangles triangles = sheet(8, 0);
    const grid::GridCells cells = grid::cells_around(triangles, 16);
    std::vector<Segment> segments;
    for (int exponent = 0; exponent < 127; ++exponent) {
        const float far = std::ldexp(1.0F, exponent);
        for (const float side : {far, -far}) {
            segments.push_back({{3.25F, 4.75F, side}, {3.25F, 4.75F, -0.5F * side}});
            segments.push_back({{4, 4, side}, {4, 4, -side}});
            segments.push_back({{side, side, side}, {-side, -side, -side}});
        }
    }
    for (const cl_uint hit : ask(triangles, cells, segments, Storage::counted).any)
        REQUIRE(hit == 1);
    for (Segment& segment : segments) {
        segment.from.x += 9;
        segment.to.x += 9;
    }
    require_same(triangles, cells, segments);
}

TEST_CASE("no triangle, one point, one plane, and triangles that are not finite") {
    require_same({}, 8, 90);
    require_same({{glm::vec3(2), glm::vec3(2), glm::vec3(2)}}, 8, 90);
    require_same(sheet(5, 1e6F), 64);
    Triangles triangles = sheet(2, 0);
    triangles.push_back({glm::vec3(std::numeric_limits<float>::quiet_NaN()), {}, {}});
    triangles.push_back({{}, glm::vec3(std::numeric_limits<float>::infinity(), 0, 0), {}});
    grid::TriangleGrid grid(device(), triangles, grid::cells_around(triangles, 8));
    CHECK(grid.build().rejected == 2);
}

TEST_CASE("meshes far from the origin, and very large or small") {
    for (const float scale : {1e-31F, 1e-18F, 1e-6F, 1e12F, 1e30F})
        for (const float shift : {0.0F, 1e4F}) {
            Triangles triangles = sheet(6, 0.5F);
            for (GridTriangle& t : triangles)
                for (glm::vec3* corner : {&t.a, &t.b, &t.c})
                    *corner = scale * (*corner + glm::vec3(shift));
            INFO(scale << ", " << shift);
            require_same(triangles, 13);
        }
}

}  // namespace
}  // namespace cellist::test
