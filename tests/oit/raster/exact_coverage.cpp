// SPDX-License-Identifier: MIT
// With exact coverage, a triangle has a fragment in every pixel of which it overlaps a part.
#include "oit/support/polygons.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

using Triangle = std::array<Point, 3>;

// A fragment wherever the part that the triangle covers is certainly more than nothing, and none
// where it is nothing.
void require_overlaps(const std::vector<Triangle>& triangles, int width, int height) {
    support::Mesh mesh;
    std::vector<cl_uint> least(static_cast<std::size_t>(width * height), 0), most = least;
    for (const auto& [a, b, c] : triangles) {
        add_triangle(mesh, a, b, c);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double part = covered_part(a, b, c, x, y, width, height);
                const auto pixel = static_cast<std::size_t>(y * width + x);
                least[pixel] += part > 1e-10 ? 1U : 0U;
                most[pixel] += part > 1e-14 ? 1U : 0U;
            }
    }
    const Coverage coverage = coverage_of(mesh, pixel_view(width, height), {.exact = true});
    std::size_t wrong = 0;
    for (std::size_t p = 0; p < least.size(); ++p)
        if (coverage.counts[p] < least[p] || coverage.counts[p] > most[p]) ++wrong;
    REQUIRE(wrong == 0);
}

std::vector<Triangle> random_triangles(std::mt19937& random, std::size_t count, int reach,
                                       int step) {
    const auto coordinate = [&] {
        return static_cast<int>(below(random, static_cast<std::uint32_t>(2 * reach / step + 1))) *
                   step -
               reach;
    };
    std::vector<Triangle> triangles(count);
    for (Triangle& triangle : triangles)
        for (Point& p : triangle) p = {coordinate(), coordinate()};
    return triangles;
}

TEST_CASE("triangles of any size have a fragment in each pixel that they overlap") {
    CELLIST_RANDOM(random, 71u);
    for (const int reach_pixels : {1, 2, 12, 40, 200, 1000, 8000}) {
        INFO("reach " << reach_pixels << " pixels");
        require_overlaps(random_triangles(random, 60, 256 * reach_pixels, 1), 80, 50);
    }
}

TEST_CASE("triangles that only touch a pixel have no fragment there") {
    CELLIST_RANDOM(random, 72u);
    // Even sizes put corners of pixels on multiples of 256, where these corners lie.
    for (const int reach_pixels : {1, 3, 20, 60}) {
        INFO("reach " << reach_pixels << " pixels");
        require_overlaps(random_triangles(random, 80, 256 * reach_pixels, 256), 60, 40);
    }
}

TEST_CASE("slivers and triangles inside of one pixel have their fragments") {
    CELLIST_RANDOM(random, 73u);
    std::vector<Triangle> slivers = random_triangles(random, 100, 40 * 256, 1);
    for (Triangle& triangle : slivers)
        triangle[2] = {triangle[1].x + static_cast<int>(below(random, 5)) - 2,
                       triangle[1].y + static_cast<int>(below(random, 5)) - 2};
    require_overlaps(slivers, 80, 50);
    require_overlaps(random_triangles(random, 500, 64, 1), 8, 6);
    // Without area.
    require_overlaps({{Point{0, 0}, Point{0, 0}, Point{0, 0}},
                      {Point{-5120, 0}, Point{0, 0}, Point{5120, 0}},
                      {Point{-50000, -50000}, Point{0, 0}, Point{50000, 50000}}},
                     31, 31);
}

TEST_CASE("a triangle that covers exactly one pixel has one fragment there") {
    // Half of the pixel, the pixel in two halves, and its double with legs of two pixels.
    require_overlaps({{Point{0, 0}, Point{256, 0}, Point{0, 256}}}, 4, 4);
    require_overlaps({{Point{0, 0}, Point{256, 0}, Point{0, 256}},
                      {Point{256, 0}, Point{256, 256}, Point{0, 256}}},
                     4, 4);
    require_overlaps({{Point{0, 0}, Point{512, 0}, Point{0, 512}}}, 4, 4);
}

}  // namespace
}  // namespace cellist::test
