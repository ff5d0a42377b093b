// SPDX-License-Identifier: MIT
// Merged ranges against those that they are made from, and pictures in slices against whole ones.
#include <algorithm>
#include <bit>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "renderer.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/oracle.hpp"
#include "support/random.hpp"
#include "support/random_scenes.hpp"
#include "support/range_map.hpp"

namespace cellist::test {
namespace {

constexpr double nothing_there = std::numeric_limits<double>::infinity();

// Sheets that nearly touch, at distances around the tolerance, and that move through one another.
motion::Scene layers(std::mt19937& random) {
    motion::Scene scene;
    scene.name = "layers";
    scene.light.is_spot = true;
    scene.light.position = {0, 4, 0};
    scene.light.target = {0, 0, 0};
    scene.light.field_degrees = 40;
    for (int layer = 0; layer < 40; ++layer) {
        const double height = 1 + between(random, 0, 0.08), way = between(random, -0.05, 0.05);
        const double turn = between(random, -0.1, 0.1);
        const glm::vec3 move(between(random, -0.3, 0.3), way, between(random, -0.3, 0.3));
        constexpr int cells = 6;
        const auto first = static_cast<std::uint32_t>(scene.begin.size());
        const double size = between(random, 0.5, 2);
        for (int z = 0; z <= cells; ++z)
            for (int x = 0; x <= cells; ++x) {
                const glm::dvec2 p(size * (double(x) / cells - 0.5),
                                   size * (double(z) / cells - 0.5));
                scene.begin.emplace_back(p.x, height + turn * p.x, p.y);
                scene.end.push_back(scene.begin.back() + move +
                                    glm::vec3(0, -1.5 * turn * p.x * p.y, 0));
            }
        for (std::uint32_t z = 0; z < cells; ++z)
            for (std::uint32_t x = 0; x < cells; ++x) {
                const std::uint32_t a = first + z * (cells + 1) + x, d = a + cells + 1;
                scene.triangles.emplace_back(a, d, d + 1);
                scene.triangles.emplace_back(a, d + 1, a + 1);
            }
    }
    scene.colours.resize(scene.triangles.size(), glm::u8vec4(255));
    return scene;
}

std::vector<motion::Scene> scenes_to_merge(std::mt19937& random) {
    std::vector<motion::Scene> scenes{motion::make_cubes(),
                                      motion::make_fan(),
                                      motion::make_blinds(),
                                      motion::make_walker(20'000),
                                      layers(random),
                                      random_scene(random, 2000, true),
                                      random_scene(random, 2000, false)};
    // The light is among the triangles: its plane and near plane cut through them.
    scenes.push_back(random_scene(random, 2000, true));
    scenes.back().light.position = {0.1, 0.3, 0.2};
    scenes.back().light.target = {0, -1, 0};
    scenes.back().light.field_degrees = 80;
    scenes.back().name = "random, light inside";
    scenes.push_back(random_scene(random, 2000, false));
    scenes.back().light.position = {0.1, 0.3, 0.2};
    scenes.back().name = "random, parallel light inside";
    return scenes;
}

TEST_CASE("merged ranges have the depth of those that they replace, within the tolerance") {
    constexpr int side = 256;
    constexpr float tolerance = 0.25F;
    CELLIST_RANDOM(random, 7);
    for (const motion::Scene& scene : scenes_to_merge(random)) {
        INFO(scene.name);
        RangeMap map(device(), scene, side);
        const motion::View& view = map.view();
        const HostLists<motion::VisibleRange> ranges = map.ranges();
        const HostLists<motion::DepthPiece> pieces = map.pieces(tolerance);
        const std::vector<DoubleVertex> vertices = exactly(map.vertices());
        std::size_t tries = 0, differ_in_cover = 0, lit_instead = 0;
        double largest = 0;
        std::size_t over = 0;
        while (tries < 100'000) {
            const std::uint32_t texel = below(random, side * side);
            if (ranges.cell(texel).empty() && random() % 16 != 0) continue;
            for (int k = 0; k < 4; ++k, ++tries) {
                const double time = between(random, 0, 1);
                const glm::dvec2 place = centre_of(view, texel);
                double nearest = nothing_there, merged = nothing_there, rounding = 0;
                bool is_at_near_plane = false;
                for (const motion::VisibleRange& r : ranges.cell(texel)) {
                    if (time < double(r.begin) || time >= double(r.end)) continue;
                    const DoubleTriangle t = triangle_of(vertices, scene.triangles[r.triangle]);
                    const double depth = at_moment(t, place, time).depth;
                    // Within the time that compress.cl may be off.
                    const auto is_seen = [&](double t2) {
                        return at_moment(t, place, t2).depth >= double(view.near_depth);
                    };
                    is_at_near_plane =
                        is_at_near_plane || is_seen(time - 0x1p-15) != is_seen(time + 0x1p-15);
                    if (depth < double(view.near_depth) || depth >= nearest) continue;
                    nearest = depth;
                    // Where the light sees the plane nearly from its edge, depth is not certain.
                    rounding = 4e-6 * depth;
                    for (const glm::dvec2& step : {glm::dvec2(1e-4, 0), glm::dvec2(0, 1e-4)})
                        rounding += std::abs(at_moment(t, place + step, time).depth - depth);
                }
                for (const motion::DepthPiece& p : pieces.cell(texel)) {
                    if (time < double(p.begin) || time >= double(p.end)) continue;
                    const double part =
                        (time - double(p.begin)) / (double(p.end) - double(p.begin));
                    merged = std::min(merged,
                                      std::lerp(double(p.depth_begin), double(p.depth_end), part));
                }
                if (is_at_near_plane) continue;
                if ((nearest == nothing_there) != (merged == nothing_there)) {
                    ++differ_in_cover;
                    if (merged == nothing_there) ++lit_instead;
                    continue;
                }
                if (nearest == nothing_there) continue;
                const double texel_size =
                    double(view.pixel) * (view.is_parallel != 0 ? 1 : nearest);
                const double error =
                    std::max(0.0, std::abs(merged - nearest) - rounding) / texel_size;
                largest = std::max(largest, error);
                if (error > double(tolerance)) ++over;
            }
        }
        std::cout << scene.name << ": " << ranges.records().size() << " ranges, "
                  << pieces.records().size() << " merged, largest error " << largest << " texels, "
                  << over << " beyond the tolerance, " << differ_in_cover << " differ in cover ("
                  << lit_instead << " lit)\n";
        CHECK(differ_in_cover == 0);
        CHECK(largest <= double(tolerance));
        if (scene.light.position.y > 1) CHECK(pieces.records().size() < ranges.records().size());
    }
}

std::vector<cl_float4> picture_of(const motion::Scene& scene, motion::Settings settings,
                                  std::uint64_t* slices = nullptr) {
    settings.width = 160;
    settings.height = 120;
    settings.shadow_map = 256;
    settings.samples = 8;
    motion::Renderer renderer(device(), scene, settings);
    const auto method = motion::make_exact(renderer.frame());
    renderer.draw(*method);
    if (slices != nullptr) *slices = method->size().slices;
    return renderer.picture().download();
}

bool is_same(const std::vector<cl_float4>& a, const std::vector<cl_float4>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return std::equal(std::begin(x.s), std::end(x.s), std::begin(y.s), std::end(y.s));
    });
}

TEST_CASE("a picture in slices is that of a whole shadow map, bit for bit") {
    for (const motion::Scene& scene : {motion::make_cubes(), motion::make_blinds()})
        for (const bool compress : {false, true}) {
            INFO(scene.name << (compress ? ", compressed" : ""));
            motion::Settings settings{.compress = compress};
            const std::vector<cl_float4> whole = picture_of(scene, settings);
            for (const cellist::Storage storage :
                 {cellist::Storage::linked, cellist::Storage::counted}) {
                settings.storage = storage;
                settings.budget_bytes = motion::no_budget;
                CHECK(is_same(whole, picture_of(scene, settings)));
                settings.budget_bytes = 700'000;
                std::uint64_t slices = 0;
                CHECK(is_same(whole, picture_of(scene, settings, &slices)));
                CHECK(slices > 1);
            }
        }
}

TEST_CASE("the prepass changes no picture that is not merged") {
    for (const motion::Scene& scene : {motion::make_cubes(), motion::make_fan()}) {
        INFO(scene.name);
        CHECK(is_same(picture_of(scene, {.prepass = true, .compress = false}),
                      picture_of(scene, {.prepass = false, .compress = false})));
    }
}

}  // namespace
}  // namespace cellist::test
