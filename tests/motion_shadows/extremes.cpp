// SPDX-License-Identifier: MIT
// Triangles, motions and settings at their limits.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <glm/common.hpp>

#include "accumulate.hpp"
#include "renderer.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/oracle.hpp"
#include "support/random.hpp"
#include "support/random_scenes.hpp"
#include "support/range_map.hpp"

namespace cellist::test {
namespace {

const std::vector<std::function<std::unique_ptr<motion::ShadowMethod>(const motion::Frame&)>>
    all_methods{motion::make_exact, motion::make_tsm, motion::make_still};

constexpr double no_limit = std::numeric_limits<double>::infinity();

// The largest difference, over all texels and triangles, of the time that a triangle covers a texel
// in front of the near plane.
double largest_error(const motion::Scene& scene, int side = 64) {
    RangeMap map(device(), scene, side);
    const HostLists<motion::VisibleRange> ranges = map.ranges();
    const std::vector<DoubleVertex> vertices = exactly(map.vertices());
    const TriangleGrid grid(vertices, scene.triangles, map.view());
    const double nearest = double(map.view().near_depth);
    double largest = 0;
    std::vector<Times> device_says(scene.triangles.size());
    for (std::size_t texel = 0; texel < ranges.cells(); ++texel) {
        const glm::dvec2 place = centre_of(map.view(), texel);
        for (const motion::VisibleRange& r : ranges.cell(texel))
            device_says[r.triangle].emplace_back(r.begin, r.end);
        const auto time_of = [&](std::uint32_t i, const Times& times) {
            return total(nearer_times(triangle_of(vertices, scene.triangles[i]), place, times,
                                      nearest, no_limit));
        };
        for (const std::uint32_t i : grid.near(texel)) {
            const double expected =
                time_of(i, covered_times(triangle_of(vertices, scene.triangles[i]), place));
            largest = std::max(largest, std::abs(time_of(i, device_says[i]) - expected));
            device_says[i].clear();
        }
        // Of triangles that the grid does not know here.
        for (const motion::VisibleRange& r : ranges.cell(texel)) {
            largest = std::max(largest, time_of(r.triangle, device_says[r.triangle]));
            device_says[r.triangle].clear();
        }
    }
    return largest;
}

// Changes each triangle of random scenes, and compares their times with double precision.
using Change = std::function<void(std::mt19937&, glm::vec3* begin, glm::vec3* end)>;

void check_triangles(const Change& change, std::size_t triangles = 1000) {
    CELLIST_RANDOM(random, 8);
    for (const bool is_spot : {true, false}) {
        motion::Scene scene = random_scene(random, triangles, is_spot);
        for (std::size_t i = 0; i < scene.begin.size(); i += 3)
            change(random, &scene.begin[i], &scene.end[i]);
        INFO(scene.name);
        CHECK(largest_error(scene) <= 1e-5);
    }
}

TEST_CASE("a triangle that does not move covers a texel for the whole exposure or never") {
    CELLIST_RANDOM(random, 9);
    motion::Scene scene = random_scene(random, 1000, true);
    scene.end = scene.begin;
    CHECK(largest_error(scene) == 0);
    RangeMap map(device(), scene, 64);
    const HostLists<motion::VisibleRange> ranges = map.ranges();
    CHECK(ranges.records().size() > 1000);
    for (const motion::VisibleRange& r : ranges.records()) {
        REQUIRE(r.begin == 0);
        REQUIRE(r.end == 1);
    }
}

TEST_CASE("triangles collapse to a line or a point, and turn inside out") {
    SECTION("to a point at the end") {
        check_triangles(
            [](std::mt19937&, glm::vec3*, glm::vec3* end) { end[1] = end[2] = end[0]; });
    }
    SECTION("from a point at the begin") {
        check_triangles(
            [](std::mt19937&, glm::vec3* begin, glm::vec3*) { begin[1] = begin[2] = begin[0]; });
    }
    SECTION("to an edge") {
        check_triangles([](std::mt19937&, glm::vec3*, glm::vec3* end) { end[1] = end[2]; });
    }
    SECTION("to a line") {
        check_triangles(
            [](std::mt19937&, glm::vec3*, glm::vec3* end) { end[1] = 0.5F * (end[0] + end[2]); });
    }
    SECTION("to a point at half time, and inside out after it") {
        check_triangles([](std::mt19937&, glm::vec3* begin, glm::vec3* end) {
            const glm::vec3 middle = begin[0] + 0.5F * (begin[1] - begin[2]);
            for (int k = 0; k < 3; ++k) end[k] = 2.0F * middle - begin[k];
        });
    }
    SECTION("two corners change places") {
        check_triangles([](std::mt19937&, glm::vec3* begin, glm::vec3* end) {
            end[0] = begin[0];
            end[1] = begin[2];
            end[2] = begin[1];
        });
    }
}

TEST_CASE("a triangle that is always a line or a point is never seen") {
    CELLIST_RANDOM(random, 10);
    motion::Scene scene = random_scene(random, 300, false);
    for (std::size_t i = 0; i < scene.begin.size(); i += 3) {
        if (i % 2 == 0) {
            scene.begin[i + 1] = scene.begin[i + 2] = scene.begin[i];
            scene.end[i + 1] = scene.end[i + 2] = scene.end[i];
        } else {
            scene.begin[i + 1] = scene.begin[i];
            scene.end[i + 1] = scene.end[i];
        }
    }
    CHECK(RangeMap(device(), scene, 64).ranges().records().empty());
    // No picture shows them.
    for (const auto& make : all_methods) {
        motion::Renderer renderer(device(), scene, {.width = 64, .height = 64, .shadow_map = 64});
        const auto method = make(renderer.frame());
        renderer.draw(*method);
        for (const cl_float4& p : renderer.picture().download()) REQUIRE(p.s[0] == Approx(0.02));
    }
}

TEST_CASE("edges move along themselves, or parallel to themselves") {
    SECTION("along") {
        check_triangles([](std::mt19937& random, glm::vec3* begin, glm::vec3* end) {
            const auto part = static_cast<float>(between(random, -2, 2));
            for (int k = 0; k < 3; ++k) end[k] = begin[k] + part * (begin[1] - begin[0]);
        });
    }
    SECTION("parallel") {
        check_triangles([](std::mt19937& random, glm::vec3* begin, glm::vec3* end) {
            const glm::vec3 move = point(random, 1);
            for (int k = 0; k < 3; ++k) end[k] = begin[k] + move;
        });
    }
}

TEST_CASE("triangles pass through the plane and the near plane of the light") {
    CELLIST_RANDOM(random, 11);
    for (const bool is_spot : {true, false}) {
        motion::Scene scene = random_scene(random, 1000, is_spot);
        scene.light.position = {0.1, 0.3, 0.2};
        scene.light.target = {0, -1, 0};
        scene.light.field_degrees = 80;
        INFO(scene.name);
        CHECK(largest_error(scene) <= 1e-5);
    }
}

TEST_CASE("motions of a thousand screens") {
    check_triangles(
        [](std::mt19937& random, glm::vec3* begin, glm::vec3* end) {
            // Through the middle of the scene at a random time.
            const glm::vec3 way = 2400.0F * point(random, 1);
            const auto t = static_cast<float>(between(random, 0, 1));
            for (int k = 0; k < 3; ++k) {
                begin[k] += t * -way;
                end[k] = begin[k] + way;
            }
        },
        200);
}

TEST_CASE("coordinates as far away as they may be") {
    check_triangles([](std::mt19937& random, glm::vec3* begin, glm::vec3* end) {
        const auto scale = static_cast<float>(std::pow(10, between(random, 0, 9)));
        for (int k = 0; k < 3; ++k) {
            // Below the light, so that its depth is as large.
            begin[k] = scale * begin[k] - glm::vec3(0, scale, 0);
            end[k] = scale * end[k] - glm::vec3(0, scale, 0);
        }
    });
}

TEST_CASE("triangles with vertices that are not finite are dropped and counted") {
    CELLIST_RANDOM(random, 12);
    const motion::Scene good = random_scene(random, 500, true);
    motion::Scene bad = good;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> values{std::numeric_limits<float>::quiet_NaN(), infinity, -infinity,
                                    std::numeric_limits<float>::max(), 1e30F};
    std::size_t added = 0;
    for (const float value : values)
        for (int axis = 0; axis < 3; ++axis)
            for (const bool at_end : {false, true}) {
                const auto first = static_cast<std::uint32_t>(bad.begin.size());
                for (int k = 0; k < 3; ++k) {
                    bad.begin.push_back(point(random, 1));
                    bad.end.push_back(bad.begin.back());
                }
                (at_end ? bad.end : bad.begin).back()[axis] = value;
                bad.triangles.emplace_back(first, first + 1, first + 2);
                bad.colours.emplace_back(255);
                ++added;
            }
    RangeMap with(device(), bad, 64), without(device(), good, 64);
    CHECK(with.report().rejected == added);
    CHECK(without.report().rejected == 0);
    const auto as_text = [](const HostLists<motion::VisibleRange>& lists) {
        std::vector<std::string> text;
        for (std::size_t cell = 0; cell < lists.cells(); ++cell)
            for (const motion::VisibleRange& r : lists.cell(cell))
                text.push_back(std::to_string(cell) + " " + std::to_string(r.begin) + " " +
                               std::to_string(r.end) + " " + std::to_string(r.triangle));
        std::sort(text.begin(), text.end());
        return text;
    };
    CHECK(as_text(with.ranges()) == as_text(without.ranges()));

    motion::Settings settings{.width = 40, .height = 30, .shadow_map = 64, .samples = 4};
    const auto picture = [&](const motion::Scene& scene, std::uint64_t& refused) {
        motion::Renderer renderer(device(), scene, settings);
        const auto method = motion::make_exact(renderer.frame());
        renderer.draw(*method);
        refused = method->size().refused;
        std::vector<float> values_of_picture;
        for (const cl_float4& p : renderer.picture().download())
            values_of_picture.insert(values_of_picture.end(), std::begin(p.s), std::end(p.s));
        return values_of_picture;
    };
    for (const bool in_slices : {false, true}) {
        settings.budget_bytes = in_slices ? 200'000 : motion::no_budget;
        std::uint64_t refused = 0, refused_without = 1;
        CHECK(picture(bad, refused) == picture(good, refused_without));
        CHECK(refused == added);
        CHECK(refused_without == 0);
    }
}

TEST_CASE("a texel holds 100,000 ranges") {
    CELLIST_RANDOM(random, 13);
    motion::Scene scene = random_scene(random, 0, true);
    constexpr std::size_t count = 100'000;
    for (std::size_t i = 0; i < count; ++i) {
        // All cross the only texel of the light's image at some time.
        const auto y = static_cast<float>(between(random, 0, 2));
        const auto x = static_cast<float>(between(random, -3, 3));
        const auto first = static_cast<std::uint32_t>(scene.begin.size());
        const glm::vec3 a(-0.6F, y, -0.6F), b(0.6F, y, -0.6F), c(0, y, 0.9F);
        const glm::vec3 offset(0.3F, 0, 0.2F), way(4 - std::abs(x), 0.1F * x, 0);
        for (const glm::vec3& p : {a, b, c}) {
            scene.begin.push_back(p + offset - 0.5F * way);
            scene.end.push_back(p + offset + 0.5F * way);
        }
        scene.triangles.emplace_back(first, first + 1, first + 2);
    }
    scene.colours.resize(count, glm::u8vec4(255));
    scene.light.target = {0.3, 0, 0.2};
    RangeMap map(device(), scene, 1);
    const HostLists<motion::VisibleRange> ranges = map.ranges();
    REQUIRE(ranges.cells() == 1);
    REQUIRE(ranges.records().size() >= count);
    CHECK(std::is_sorted(ranges.records().begin(), ranges.records().end(),
                         [](const auto& a, const auto& b) { return a.begin < b.begin; }));
    const std::vector<DoubleVertex> vertices = exactly(map.vertices());
    const glm::dvec2 place(0);
    for (const double limit : {2.2, 2.5, 3.0, 3.5, 5.0}) {
        Times device_says, expected;
        for (const motion::VisibleRange& r : ranges.records())
            for (const auto& part :
                 nearer_times(triangle_of(vertices, scene.triangles[r.triangle]), place,
                              {{r.begin, r.end}}, double(map.view().near_depth), limit))
                device_says.push_back(part);
        for (const glm::uvec3& corners : scene.triangles) {
            const DoubleTriangle t = triangle_of(vertices, corners);
            for (const auto& part : nearer_times(t, place, covered_times(t, place),
                                                 double(map.view().near_depth), limit))
                expected.push_back(part);
        }
        INFO("limit " << limit);
        CHECK(total(device_says) == Approx(total(expected)).margin(1e-5));
    }
    CHECK(map.pieces(0.25F).records().size() < count);
}

bool is_finite(const std::vector<cl_float4>& picture) {
    return std::all_of(picture.begin(), picture.end(), [](const cl_float4& p) {
        return std::all_of(std::begin(p.s), std::end(p.s),
                           [](float v) { return std::isfinite(v) && v >= 0; });
    });
}

TEST_CASE("0, 1 and 10,000 samples, pictures and shadow maps of 1 by 1") {
    motion::Scene scene = motion::make_cubes();
    scene.target = {0.14, 1.3, -0.08};
    for (const int side : {1, 5})
        for (const cl_uint samples : {0U, 1U, 31U, 32U, 33U, side == 1 ? 10'000U : 65U})
            for (const auto& make : all_methods) {
                const motion::Settings settings{
                    .width = side, .height = side, .shadow_map = side, .samples = samples};
                INFO(side << ", " << samples << " samples");
                motion::Renderer renderer(device(), scene, settings);
                const auto method = make(renderer.frame());
                renderer.draw(*method);
                const std::vector<cl_float4> picture = renderer.picture().download();
                REQUIRE(picture.size() == static_cast<std::size_t>(side * side));
                CHECK(is_finite(picture));
                const bool is_black = std::all_of(picture.begin(), picture.end(),
                                                  [](const auto& p) { return p.s[0] == 0; });
                CHECK(is_black == (samples == 0));
            }
    motion::Settings settings{.width = 1, .height = 1, .shadow_map = 1};
    motion::Renderer renderer(device(), scene, settings);
    motion::Accumulation accumulation(renderer.frame());
    accumulation.draw(0, 0, 0);
    CHECK(is_finite(accumulation.picture(0)));
}

TEST_CASE("many samples are drawn in batches with the same picture as their mean") {
    // The mean of 63 batches is that of the reference.
    const motion::Scene scene = motion::make_cubes();
    const motion::Settings settings{.width = 8, .height = 6, .shadow_map = 128, .samples = 2000};
    motion::Renderer renderer(device(), scene, settings);
    const auto method = motion::make_exact(renderer.frame());
    renderer.draw(*method);
    motion::Accumulation accumulation(renderer.frame());
    accumulation.draw(0, 1000, 1000);
    const std::vector<cl_float4> exact = renderer.picture().download();
    const std::vector<cl_float4> reference = accumulation.picture(1000);
    for (std::size_t i = 0; i < exact.size(); ++i)
        for (const std::size_t k : {0U, 3U})
            CHECK(double(exact[i].s[k]) == Approx(double(reference[i].s[k])).margin(0.02));
}

TEST_CASE("an exposure of 0 has the shadows of a single moment") {
    motion::Scene scene = motion::make_blinds();
    scene.end = scene.begin;
    motion::Settings settings{.width = 160, .height = 120, .shadow_map = 256, .samples = 4};
    settings.compress = false;
    std::vector<std::vector<cl_float4>> pictures;
    for (const auto& make : all_methods) {
        motion::Renderer renderer(device(), scene, settings);
        const auto method = make(renderer.frame());
        renderer.draw(*method);
        pictures.push_back(renderer.picture().download());
    }
    for (std::size_t k = 1; k < pictures.size(); ++k) {
        std::size_t different = 0;
        for (std::size_t i = 0; i < pictures[0].size(); ++i)
            if (pictures[0][i].s[3] != pictures[k][i].s[3]) ++different;
        CHECK(different == 0);
    }
}

TEST_CASE("a scene without triangles is a picture of the background") {
    const motion::Scene scene;
    for (const bool compress : {false, true})
        for (const auto& make : all_methods) {
            const motion::Settings settings{
                .width = 8, .height = 6, .shadow_map = 8, .samples = 2, .compress = compress};
            motion::Renderer renderer(device(), scene, settings);
            const auto method = make(renderer.frame());
            renderer.draw(*method);
            for (const cl_float4& p : renderer.picture().download()) {
                CHECK(p.s[0] == Approx(0.02));
                CHECK(p.s[3] == 0);
            }
            motion::Accumulation accumulation(renderer.frame());
            accumulation.draw(0, 2, 2);
            CHECK(accumulation.picture(2)[0].s[0] == Approx(0.02));
        }
}

}  // namespace
}  // namespace cellist::test
