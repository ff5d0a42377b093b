// SPDX-License-Identifier: MIT
// Triangles that share edges leave no gap and cover no pixel twice.
#include <algorithm>
#include <cmath>

#include "oit/support/screen.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

void require_once_everywhere(const support::Mesh& mesh, int width, int height) {
    const Coverage coverage = coverage_of(mesh, pixel_view(width, height));
    REQUIRE(std::ranges::count(coverage.counts, 1u) ==
            static_cast<std::ptrdiff_t>(coverage.counts.size()));
}

TEST_CASE("a grid of jittered triangles covers every pixel once") {
    CELLIST_RANDOM(random, 21u);
    for (const int cell_pixels : {1, 3, 20, 70}) {
        INFO("cells of " << cell_pixels << " pixels");
        constexpr int side = 97;
        const int cells = side / cell_pixels + 3;
        const int cell = cell_pixels * 256;
        std::vector<Point> points;
        for (int y = 0; y <= cells; ++y)
            for (int x = 0; x <= cells; ++x) {
                // Quads stay convex: no corner moves by more than a quarter of a cell.
                const auto jitter = [&] {
                    return static_cast<int>(
                               below(random, static_cast<std::uint32_t>(cell / 2 - 1))) -
                           cell / 4;
                };
                points.push_back({(2 * x - cells) * cell / 2 + jitter() * 9 / 10,
                                  (2 * y - cells) * cell / 2 + jitter() * 9 / 10});
            }
        support::Mesh mesh;
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x) {
                const auto at = [&](int i, int j) {
                    return points[static_cast<std::size_t>((y + j) * (cells + 1) + x + i)];
                };
                // Windings are mixed: both sides are drawn.
                add_triangle(mesh, at(0, 0), at(1, 0), at(1, 1));
                add_triangle(mesh, at(1, 1), at(0, 0), at(0, 1));
            }
        require_once_everywhere(mesh, side, side);
    }
}

TEST_CASE("fans around a point cover every pixel once") {
    CELLIST_RANDOM(random, 22u);
    for (int round = 0; round < 12; ++round) {
        INFO("round " << round);
        constexpr int blades = 37;
        const Point hub{static_cast<int>(below(random, 8000)) - 4000,
                        static_cast<int>(below(random, 8000)) - 4000};
        support::Mesh mesh;
        std::vector<Point> rim;
        for (int i = 0; i < blades; ++i) {
            const double angle =
                6.283185307179586 * (i + 0.4 * below(random, 1000) / 1000.0) / blades;
            rim.push_back({static_cast<int>(60000 * std::cos(angle)),
                           static_cast<int>(60000 * std::sin(angle))});
        }
        for (std::size_t i = 0; i < blades; ++i)
            add_triangle(mesh, hub, rim[i], rim[(i + 1) % blades]);
        require_once_everywhere(mesh, 71, 53);
    }
}

}  // namespace
}  // namespace cellist::test
