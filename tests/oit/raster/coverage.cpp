// SPDX-License-Identifier: MIT
// A pixel is covered if its centre is in the triangle; centres on an edge belong to the left and
// top.
#include "oit/support/screen.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

// Counts the edges that a ray to the right from p crosses, each edge without its lower end and each
// crossing strictly to the right: p on a left or top edge is inside, p on a right or bottom edge is
// not. Exact for points within 2^20.
bool is_inside(const std::array<Point, 3>& triangle, Point p) {
    bool inside = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point a = triangle[i], b = triangle[(i + 1) % 3];
        if ((a.y <= p.y) == (b.y <= p.y)) continue;
        const std::int64_t dy = b.y - a.y;
        const std::int64_t beyond =
            std::int64_t{a.x - p.x} * dy + std::int64_t{b.x - a.x} * (p.y - a.y);
        if ((beyond > 0) == (dy > 0) && beyond != 0) inside = !inside;
    }
    return inside;
}

void require_coverage(const std::vector<std::array<Point, 3>>& triangles, int width, int height) {
    support::Mesh mesh;
    std::vector<cl_uint> expected(static_cast<std::size_t>(width * height), 0);
    for (const auto& triangle : triangles) {
        add_triangle(mesh, triangle[0], triangle[1], triangle[2]);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (is_inside(triangle, {(2 * x + 1 - width) * 128, (2 * y + 1 - height) * 128}))
                    ++expected[static_cast<std::size_t>(y * width + x)];
    }
    const Coverage coverage = coverage_of(mesh, pixel_view(width, height));
    REQUIRE(coverage.counts == expected);
}

std::array<Point, 3> random_triangle(std::mt19937& random, int reach, int step) {
    std::array<Point, 3> triangle{};
    const auto coordinate = [&] {
        const auto steps = static_cast<std::uint32_t>(2 * reach / step + 1);
        return static_cast<int>(below(random, steps)) * step - reach;
    };
    for (Point& p : triangle) p = {coordinate(), coordinate()};
    return triangle;
}

TEST_CASE("random triangles cover the pixels whose centres they contain") {
    CELLIST_RANDOM(random, 11u);
    // From a few pixels, over the image, to far beyond it.
    for (const int reach_pixels : {2, 12, 40, 200, 1000}) {
        INFO("reach " << reach_pixels << " pixels");
        std::vector<std::array<Point, 3>> triangles;
        for (int i = 0; i < 60; ++i)
            triangles.push_back(random_triangle(random, reach_pixels * 256, 1));
        require_coverage(triangles, 80, 50);
    }
}

TEST_CASE("edges and corners on pixel centres follow the top-left rule") {
    CELLIST_RANDOM(random, 12u);
    for (const int reach_pixels : {3, 20, 60}) {
        INFO("reach " << reach_pixels << " pixels");
        std::vector<std::array<Point, 3>> triangles;
        // Odd sizes put pixel centres on multiples of 256, where these corners lie.
        for (int i = 0; i < 80; ++i)
            triangles.push_back(random_triangle(random, reach_pixels * 256, 256));
        require_coverage(triangles, 61, 41);
    }
}

TEST_CASE("triangles without area cover nothing") {
    require_coverage({{Point{0, 0}, Point{0, 0}, Point{0, 0}},
                      {Point{-5120, 0}, Point{0, 0}, Point{5120, 0}},
                      {Point{-50000, -50000}, Point{0, 0}, Point{50000, 50000}}},
                     31, 31);
}

TEST_CASE("slivers cover the few centres that they contain") {
    CELLIST_RANDOM(random, 13u);
    std::vector<std::array<Point, 3>> triangles;
    for (int i = 0; i < 100; ++i) {
        std::array<Point, 3> triangle = random_triangle(random, 40 * 256, 1);
        triangle[2] = {triangle[1].x + static_cast<int>(below(random, 5)) - 2,
                       triangle[1].y + static_cast<int>(below(random, 5)) - 2};
        triangles.push_back(triangle);
    }
    require_coverage(triangles, 80, 50);
}

TEST_CASE("images of one row, one column and one pixel are covered") {
    const std::array<Point, 3> all{Point{-100000, -100000}, Point{300000, -100000},
                                   Point{-100000, 300000}};
    require_coverage({all}, 1, 1);
    require_coverage({all}, 67, 1);
    require_coverage({all}, 1, 67);
}

}  // namespace
}  // namespace cellist::test
