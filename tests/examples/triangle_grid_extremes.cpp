// SPDX-License-Identifier: MIT
// Grids at their limits; docs/numerics.md names these tests.
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include <cellist/cellist.hpp>

#include "examples/triangle_grid.hpp"
#include "input_error.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

class Places {
public:
    explicit Places(std::uint32_t seed) : random_(seed) {}
    float number() { return uniform_(random_); }  // -1 to 1
    glm::vec3 point() { return {number(), number(), number()}; }
    glm::vec3 direction() { return glm::normalize(point()); }
    std::mt19937& random() { return random_; }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> uniform_{-1, 1};
};

// Segments through places on the triangles, from all sides.
std::vector<Segment> through(const Triangles& triangles, std::size_t count, float length,
                             Places& places) {
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < count; ++i) {
        const GridTriangle& t = triangles[places.random()() % triangles.size()];
        float u = std::abs(places.number()), v = std::abs(places.number());
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const glm::vec3 target = t.a + u * (t.b - t.a) + v * (t.c - t.a);
        const glm::vec3 along = length * places.direction();
        segments.push_back({target - along, target + along});
    }
    return segments;
}

TEST_CASE("segments in the last faces of grids of every extent") {
    for (const int extent : {4, 17, 20, 24, 28, 31, 36}) {
        const auto end = static_cast<float>(extent);
        // Points at two corners set the extent; between them, most bricks are empty.
        Triangles triangles{{glm::vec3(0), glm::vec3(0), glm::vec3(0)},
                            {glm::vec3(end), glm::vec3(end), glm::vec3(end)}};
        std::vector<Segment> segments;
        for (int axis = 0; axis < 3; ++axis)
            for (const float face : {0.0F, end}) {
                const int j = (axis + 1) % 3, k = (axis + 2) % 3;
                GridTriangle triangle{glm::vec3(0.8F * end), glm::vec3(0.8F * end),
                                      glm::vec3(0.8F * end)};
                triangle.a[axis] = triangle.b[axis] = face;
                triangle.a[j] -= 0.3F;
                triangle.b[j] += 0.3F;
                triangle.c[axis] = 0.9F * face + 0.05F * end;
                triangles.push_back(triangle);
                glm::vec3 from(0.8F * end), to(0.8F * end);
                from[axis] = to[axis] = face;
                from[k] = 0;
                to[k] = end;
                segments.push_back({from, to});
                segments.push_back({to, from});
                from[j] -= 0.25F;
                to[j] += 0.0625F;
                segments.push_back({from, to});
                segments.push_back({to, from});
            }
        const grid::GridCells cells = grid::cells_around(triangles, extent);
        REQUIRE(cells.extent[0] == extent);
        INFO(extent);
        const GridAnswers answers = ask(triangles, cells, segments, Storage::counted);
        for (const cl_uint hit : answers.any) REQUIRE(hit == 1);
        require_right(triangles, segments, answers);
    }
}

TEST_CASE("needles of every direction") {
    Places places(7);
    Triangles triangles;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 a = places.point(), along = places.direction();
        const float width = std::pow(10.0F, -1.0F - static_cast<float>(i % 9));
        triangles.push_back({a, a + 0.7F * along, a + width * places.direction()});
    }
    std::vector<Segment> segments = through(triangles, 1500, 0.5F, places);
    for (const int longest : {3, 50})
        require_same(triangles, grid::cells_around(triangles, longest), segments);
}

TEST_CASE("details of 10^-3 at an offset of 10^6") {
    Places places(9);
    Triangles triangles = part_of_knot();
    for (GridTriangle& t : triangles)
        for (glm::vec3* corner : {&t.a, &t.b, &t.c})
            // As fine as floats are there: steps of 1/16 along x.
            *corner = {1e6F + std::round(64 * corner->x) / 16, 1e-3F * corner->y,
                       1e-3F * corner->z};
    require_same(triangles, 100);
    for (GridTriangle& t : triangles)
        for (glm::vec3* corner : {&t.a, &t.b, &t.c}) *corner += glm::vec3(0, 1e3F, -1e3F);
    require_same(triangles, 100);
}

TEST_CASE("everything in one cell") {
    Triangles triangles = part_of_knot();
    triangles.resize(300);
    require_same(triangles, 1);
    // A grid of many cells, in one of which all triangles are.
    const grid::GridCells cells = grid::cells_in_box(glm::dvec3(-200), glm::dvec3(300), 5, 0);
    require_same(triangles, cells, triangle_grid::make_segments(600, cells, triangles, 5));
}

TEST_CASE("segments that are not finite meet nothing and are counted") {
    const Triangles triangles = sheet(4, 0);
    std::vector<Segment> segments{{{1.5F, 1.25F, 1}, {1.5F, 1.25F, -1}}};
    for (const float bad : {nan_value, infinite, -infinite})
        for (int k = 0; k < 6; ++k) {
            Segment segment = segments[0];
            (k < 3 ? segment.from : segment.to)[k % 3] = bad;
            segments.push_back(segment);
        }
    const GridAnswers answers =
        ask(triangles, grid::cells_around(triangles, 8), segments, Storage::counted);
    CHECK(answers.invalid == 18);
    CHECK(answers.closest[0].triangle != grid::GridHit::none);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        CHECK(answers.any[i] == (i == 0 ? 1 : 0));
        if (i > 0) CHECK(answers.closest[i].triangle == grid::GridHit::none);
        if (i > 0) CHECK(answers.closest[i].at == infinite);
    }
}

TEST_CASE("a far outlier leaves the grid fine") {
    Places places(21);
    // Of every thousand triangles, one may be an outlier.
    const Triangles knot = part_of_knot(20);
    const grid::GridCells fine = grid::cells_around(knot, 64);
    grid::TriangleGrid without(device(), knot, fine);
    const std::uint64_t stored = without.build().stored;
    for (const float far : {1e6F, 1e12F, 1e30F}) {
        Triangles triangles = knot;
        // One triangle far away, and one that reaches there from the mesh.
        triangles.push_back({glm::vec3(far), glm::vec3(far, 0, 0), glm::vec3(0, far, far)});
        triangles.push_back({knot[0].a, knot[0].b, glm::vec3(far, 0.7F * far, -0.4F * far)});
        const grid::GridCells cells = grid::cells_around(triangles, 64);
        INFO(far);
        CHECK(grid::cell_side(cells) < 1.5 * grid::cell_side(fine));
        grid::TriangleGrid grid(device(), triangles, cells);
        // The cells of a triangle are told apart in double.
        const std::uint64_t listed = grid.build().stored;
        if (far < 1e13F && device().info().fp64) CHECK(listed < stored + 1000);
        std::vector<Segment> segments = triangle_grid::make_segments(900, cells, triangles, 13);
        for (const Segment& segment : through(triangles, 300, 0.2F, places))
            segments.push_back(segment);
        for (const Segment& segment : through(triangles, 300, 0.3F * far, places))
            segments.push_back(segment);
        require_right(triangles, segments, ask(grid, segments));
    }
}

TEST_CASE("huge triangles among small ones") {
    Places places(4);
    Triangles triangles = part_of_knot();
    const grid::GridCells cells = grid::cells_around(triangles, 128);
    triangles.push_back({{-9, -8, -0.3F}, {9, -8, 0.2F}, {0, 9, 0.1F}});
    triangles.push_back({{-50, 0, 0.1F}, {50, 0.1F, -60}, {50, 0.2F, 60}});
    const std::vector<Segment> segments = triangle_grid::make_segments(900, cells, triangles, 8);
    require_same(triangles, cells, segments);
    // More than there is room for parts: the others are inserted by one work-item each.
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 a = glm::vec3(-1.1F) + 0.1F * places.point();
        const glm::vec3 b = glm::vec3(1.1F) + 0.1F * places.point();
        triangles.push_back({a, b, 0.5F * (a + b) + 0.01F * places.point()});
    }
    require_same(triangles, cells, segments);
}

TEST_CASE("triangles and segments outside of the box of the grid") {
    Places places(31);
    const Triangles triangles = part_of_knot();
    for (const double side : {0.3, 1e-3}) {
        const grid::GridCells cells =
            grid::cells_in_box(glm::dvec3(0.1), glm::dvec3(0.1 + side), 16, triangles.size());
        std::vector<Segment> segments = triangle_grid::make_segments(450, cells, triangles, 6);
        for (const Segment& segment : through(triangles, 450, 1.0F, places))
            segments.push_back(segment);
        for (const Segment& segment : through(triangles, 300, 0.01F, places))
            segments.push_back(segment);
        require_same(triangles, cells, segments);
    }
    // A box that holds nothing.
    const grid::GridCells away = grid::cells_in_box(glm::dvec3(5), glm::dvec3(6), 8, 0);
    require_same(triangles, away, through(triangles, 450, 9.0F, places));
}

TEST_CASE("the closest of many layers, from every distance") {
    Triangles triangles;
    for (int layer = 0; layer < 12; ++layer)
        for (const GridTriangle& triangle : sheet(3, static_cast<float>(layer)))
            triangles.push_back(triangle);
    const grid::GridCells cells = grid::cells_around(triangles, 24);
    std::vector<Segment> segments;
    for (int exponent = 5; exponent < 127; ++exponent) {
        const float far = std::ldexp(1.0F, exponent);
        segments.push_back({{1.3F, 1.6F, far}, {1.3F, 1.6F, -far}});
        segments.push_back({{1.3F, 1.6F, -far}, {1.3F, 1.6F, far}});
    }
    const GridAnswers answers = ask(triangles, cells, segments, Storage::counted);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const grid::GridHit& hit = answers.closest[i];
        INFO(i);
        REQUIRE(hit.triangle / 18 == (i % 2 == 0 ? 11 : 0));
        CHECK(std::abs(hit.u - 0.3F) + std::abs(hit.v - 0.6F) <= 1.3F);
    }
    // Equal triangles: the lowest number.
    Triangles twice = sheet(2, 0);
    twice.insert(twice.end(), twice.begin(), twice.begin() + 8);
    const std::vector<Segment> down{{{0.7F, 0.2F, 2}, {0.7F, 0.2F, -1}}};
    CHECK(ask(twice, grid::cells_around(twice, 4), down, Storage::linked).closest[0].triangle == 0);
}

TEST_CASE("every storage gives the same answers") {
    const Triangles triangles = part_of_knot();
    const grid::GridCells cells = grid::cells_around(triangles, 0);
    const std::vector<Segment> segments = triangle_grid::make_segments(900, cells, triangles, 2);
    for (const Storage storage : {Storage::linked, Storage::counted, Storage::fixed})
        require_right(triangles, segments, ask(triangles, cells, segments, storage));
}

TEST_CASE("triangles that a kernel has moved") {
    Triangles triangles = part_of_knot();
    const grid::GridCells cells =
        grid::cells_in_box(glm::dvec3(-1.5), glm::dvec3(1.5), 40, triangles.size());
    const std::vector<Segment> segments = triangle_grid::make_segments(900, cells, triangles, 12);
    grid::TriangleGrid grid(device(), triangles, cells);
    require_right(triangles, segments, ask(grid, segments));
    for (int frame = 0; frame < 3; ++frame) {
        for (GridTriangle& t : triangles)
            for (glm::vec3* corner : {&t.a, &t.b, &t.c})
                *corner = glm::vec3(0.8F * corner->x - 0.6F * corner->y,
                                    0.6F * corner->x + 0.8F * corner->y, corner->z + 0.2F);
        Kernel move(device(),
                    Source{.text = "#include <cellist/lists.clh>\n#include <cellist/glm.clh>\n"
                                   "kernel void move(global GridTriangle* triangles, uint count,\n"
                                   "                 global const GridTriangle* moved) {\n"
                                   "    const uint i = get_global_id(0);\n"
                                   "    if (i < count) triangles[i] = moved[i];\n"
                                   "}\n",
                           .file_name = "move.cl"},
                    "move", type<GridTriangle>);
        const Buffer<GridTriangle> moved(device(), triangles);
        move.run(Range::padded(triangles.size(), 64), grid.triangles(),
                 static_cast<cl_uint>(triangles.size()), moved);
        require_right(triangles, segments, ask(grid, segments));
    }
}

TEST_CASE("grids that cannot be are refused in one line") {
    const auto message = [](auto&& work) -> std::string {
        try {
            work();
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "";
    };
    for (const int longest : {-1, GRID_EXTENT_MAX + 1, 1 << 20})
        CHECK(message([&] { (void)grid::cells_around(sheet(1, 0), longest); }) ==
              "a grid of " + std::to_string(longest) + " cells: expected 1 to 1024");
    for (const double bad : {-1.0, 1e40, std::numeric_limits<double>::quiet_NaN()})
        CHECK(message([&] {
                  (void)grid::cells_in_box(glm::dvec3(0), glm::dvec3(1, bad, 1), 8, 0);
              }).starts_with("the box of a grid reaches from 0.000000 to "));
    grid::TriangleGrid grid(device(), sheet(1, 0), grid::cells_around(sheet(1, 0), 2));
    grid::Rays rays(device(), grid);
    const Buffer<grid::GridSegment> segments(device(), 3);
    Buffer<cl_uint> any(device(), 2);
    CHECK(message([&] { rays.any_hits(segments, 3, any); }) ==
          "a buffer of 2 elements is too short for 3 segments");
    CHECK_NOTHROW(rays.any_hits(segments, 0, any));
}

}  // namespace
}  // namespace cellist::test
