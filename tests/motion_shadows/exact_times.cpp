// SPDX-License-Identifier: MIT
// The time for which a receiver is in shadow: ranges from the device against roots in double
// precision. CELLIST_TEST_PAIRS sets the number of pairs of texels and receivers.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <glm/common.hpp>

#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/oracle.hpp"
#include "support/random.hpp"
#include "support/random_scenes.hpp"
#include "support/range_map.hpp"

namespace cellist::test {
namespace {

std::size_t pairs_to_try() {
    const char* text = std::getenv("CELLIST_TEST_PAIRS");
    return text != nullptr ? std::stoul(text) : 60'000;
}

struct Errors {
    double largest = 0;
    std::size_t pairs = 0, over_1e5 = 0;
    void add(double error) {
        largest = std::max(largest, error);
        ++pairs;
        if (error > 1e-5) ++over_1e5;
    }
};

TEST_CASE("a receiver is in shadow for as long as double precision says") {
    constexpr int side = 512;
    constexpr std::size_t receivers_of_a_texel = 8;
    CELLIST_RANDOM(random, 1);
    std::vector<motion::Scene> scenes{motion::make_cubes(), motion::make_fan(),
                                      motion::make_blinds(), motion::make_walker(20'000)};
    for (const bool is_spot : {true, false}) scenes.push_back(random_scene(random, 2000, is_spot));
    scenes.push_back(motion::make_cubes());
    scenes.back().light.is_spot = false;
    scenes.back().light.side = 4;
    scenes.back().name = "cubes, parallel light";
    const std::size_t pairs = pairs_to_try() / scenes.size() + 1;
    for (const motion::Scene& scene : scenes) {
        RangeMap map(device(), scene, side);
        const motion::View& view = map.view();
        const HostLists<motion::VisibleRange> ranges = map.ranges();
        const std::vector<DoubleVertex> vertices = exactly(map.vertices());
        const std::vector<DoubleVertex> positions = projected(scene, view);
        const TriangleGrid grid(positions, scene.triangles, view);
        double least = 1e30, most = 0;
        for (const DoubleVertex& v : positions) {
            least = std::min({least, v.begin.w, v.end.w});
            most = std::max({most, v.begin.w, v.end.w});
        }
        Errors of_vertices, of_positions;
        while (of_vertices.pairs < pairs) {
            // Texels that see something: of a random point on a random triangle.
            const glm::uvec3& corners =
                scene.triangles[below(random, std::uint32_t(scene.triangles.size()))];
            const DoubleTriangle chosen = triangle_of(positions, corners);
            const double u = between(random, 0, 1), v = between(random, 0, 1 - u);
            const double t = between(random, 0, 1);
            glm::dvec4 seen(0);
            for (std::size_t k = 0; k < 3; ++k)
                seen += (k == 0   ? u
                         : k == 1 ? v
                                  : 1 - u - v) *
                        glm::mix(chosen.vertex[k].begin, chosen.vertex[k].end, t);
            const glm::dvec2 texel_place = glm::dvec2(seen) / seen.z + 0.5 * side;
            if (!(texel_place.x >= 0 && texel_place.y >= 0 && texel_place.x < side &&
                  texel_place.y < side))
                continue;
            const auto texel = static_cast<std::size_t>(texel_place.y) * side +
                               static_cast<std::size_t>(texel_place.x);
            const glm::dvec2 place = centre_of(view, texel);
            struct Blocker {
                DoubleTriangle triangle;
                Times times;
            };
            std::vector<Blocker> device_says, vertices_say, positions_say;
            for (const motion::VisibleRange& r : ranges.cell(texel))
                device_says.push_back(
                    {triangle_of(vertices, scene.triangles[r.triangle]), {{r.begin, r.end}}});
            for (const std::uint32_t i : grid.near(texel)) {
                for (const auto& [from, to] :
                     {std::pair(&vertices, &vertices_say), std::pair(&positions, &positions_say)}) {
                    const DoubleTriangle triangle = triangle_of(*from, scene.triangles[i]);
                    Times times = covered_times(triangle, place);
                    if (!times.empty()) to->push_back({triangle, std::move(times)});
                }
            }
            for (std::size_t i = 0; i < receivers_of_a_texel; ++i) {
                const double limit = i % 2 == 0 ? between(random, least, most) : seen.w + 0.01;
                const auto occluded = [&](const std::vector<Blocker>& blockers) {
                    Times times;
                    for (const Blocker& b : blockers) {
                        const Times part = nearer_times(b.triangle, place, b.times,
                                                        double(view.near_depth), limit);
                        times.insert(times.end(), part.begin(), part.end());
                    }
                    return total(std::move(times));
                };
                const double device_time = occluded(device_says);
                const double error = std::abs(device_time - occluded(vertices_say));
                of_vertices.add(error);
                of_positions.add(std::abs(device_time - occluded(positions_say)));
            }
        }
        std::cout << scene.name << ": " << of_vertices.pairs << " pairs, largest error "
                  << of_vertices.largest << " from projected vertices (" << of_vertices.over_1e5
                  << " over 1e-5), " << of_positions.largest << " from positions ("
                  << of_positions.over_1e5 << " over 1e-5)\n";
        INFO(scene.name);
        CHECK(of_vertices.largest <= 1e-5);
    }
}

}  // namespace
}  // namespace cellist::test
