// SPDX-License-Identifier: MIT
// Pixels of 2, 4 and 8 samples: which are covered, how they are blended, and what depths in each
// sample are good for.
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "oit/support/screen.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

// The patterns of Direct3D 11, in 1/16 pixel, written down once more.
const std::vector<std::vector<Point>> patterns{
    {{4, 4}, {-4, -4}},
    {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}},
    {{1, -3}, {-1, 3}, {5, 1}, {-3, -5}, {-5, 5}, {-7, -1}, {3, 7}, {7, -7}}};

// Twice the signed area of a, b, p.
std::int64_t turn(Point a, Point b, Point p) {
    return std::int64_t{b.x - a.x} * (p.y - a.y) - std::int64_t{b.y - a.y} * (p.x - a.x);
}

TEST_CASE("triangles cover the samples that they contain") {
    CELLIST_RANDOM(random, 31u);
    constexpr int width = 61, height = 43;
    for (const std::vector<Point>& pattern : patterns)
        for (const int reach_pixels : {2, 20, 400}) {
            INFO(pattern.size() << " samples, reach " << reach_pixels << " pixels");
            support::Mesh mesh;
            std::vector<cl_uint> expected(pattern.size() * width * height, 0);
            for (int i = 0; i < 60; ++i) {
                const auto coordinate = [&] {
                    const auto steps = static_cast<std::uint32_t>(512 * reach_pixels);
                    return static_cast<int>(below(random, steps)) - 256 * reach_pixels;
                };
                Point a{coordinate(), coordinate()}, b{coordinate(), coordinate()},
                    c{coordinate(), coordinate()};
                if (turn(a, b, c) < 0) std::swap(b, c);
                // Samples on an edge are decided by a rule that other tests are about.
                bool on_edge = false;
                std::vector<std::size_t> inside;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x)
                        for (std::size_t s = 0; s < pattern.size(); ++s) {
                            const Point p{(2 * x + 1 - width) * 128 + 16 * pattern[s].x,
                                          (2 * y + 1 - height) * 128 + 16 * pattern[s].y};
                            const std::int64_t least =
                                std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
                            on_edge = on_edge || least == 0;
                            if (least > 0)
                                inside.push_back(
                                    static_cast<std::size_t>(y * width + x) * pattern.size() + s);
                        }
                if (on_edge) continue;
                add_triangle(mesh, a, b, c);
                for (const std::size_t sample : inside) ++expected[sample];
            }
            REQUIRE(mesh.triangles.size() > 10);
            REQUIRE(coverage_of(mesh, pixel_view(width, height),
                                {.samples = static_cast<int>(pattern.size())})
                        .counts == expected);
        }
}

TEST_CASE("triangles that share edges cover every sample once") {
    for (const int samples : {2, 4, 8}) {
        // A fan whose hub and corners lie on samples and centres.
        support::Mesh mesh;
        const Point hub{64, -32};
        const Point rim[] = {{-40000, -40000}, {64, -40000}, {40000, -32},
                             {40000, 40000},   {64, 40000},  {-40000, 30000}};
        for (std::size_t i = 0; i < std::size(rim); ++i)
            add_triangle(mesh, hub, rim[i], rim[(i + 1) % std::size(rim)]);
        const Coverage coverage = coverage_of(mesh, pixel_view(53, 47), {.samples = samples});
        CHECK(std::ranges::count(coverage.counts, 1U) ==
              static_cast<std::ptrdiff_t>(coverage.counts.size()));
    }
}

oit::Frame sampled_frame(const oit::Scene& scene, const oit::Quality& quality) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 160, 120)},
            .quality = quality};
}

std::vector<cl_float4> require_accurate_samples(const oit::Frame& frame) {
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const oit::Comparison comparison =
        oit::compare(oit::draw_reference(frame), renderer.image(), renderer.method().depths());
    INFO(255 * comparison.max_abs_error << "/255");
    CHECK(comparison.pixels_with_other_count == 0);
    CHECK(comparison.max_depth_error <= oit::depth_resolution / 2);
    CHECK(comparison.pixels_over == comparison.pixels_explained);
    CHECK(comparison.pixels_over <= 1);
    return renderer.image();
}

TEST_CASE("samples are blended as in double precision, by pixel and by sample") {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 300, 16), 0.35F);
    oit::add_floor(scene);
    for (const int samples : {2, 4, 8}) {
        INFO(samples << " samples");
        oit::Frame frame = sampled_frame(scene, {.samples = samples});
        const std::vector<cl_float4> by_pixel = require_accurate_samples(frame);
        frame.quality.resolve = oit::Resolve::per_sample;
        const std::vector<cl_float4> by_sample = require_accurate_samples(frame);
        float largest = 0;
        for (std::size_t p = 0; p < by_pixel.size(); ++p)
            for (int c = 0; c < 3; ++c)
                largest = std::max(largest, std::abs(by_pixel[p].s[c] - by_sample[p].s[c]));
        CHECK(largest < 1e-5F);
    }
}

TEST_CASE("depths in each sample order surfaces as in double precision") {
    const oit::Scene scene = oit::scene_of(torus_knot(2, 3, 300, 16), 0.35F);
    for (const oit::Resolve resolve : {oit::Resolve::per_pixel, oit::Resolve::per_sample})
        require_accurate_samples(
            sampled_frame(scene, {.samples = 4, .resolve = resolve, .depth_range = true}));
}

// A square of a colour of its own, turned and moved.
void add_square_model(oit::Scene& scene, const glm::dmat4& place) {
    support::Mesh square;
    for (const float y : {-0.8F, 0.8F})
        for (const float x : {-0.8F, 0.8F}) {
            square.positions.emplace_back(x, y, 0.0F);
            square.normals.emplace_back(0.0F, 0.0F, 1.0F);
        }
    square.triangles = {{0, 1, 3}, {0, 3, 2}};
    const int number = static_cast<int>(scene.models.size());
    oit::Material material = oit::glass(0.8F);
    for (int c = 0; c < 3; ++c)
        material.front_tint[c] = material.back_tint[c] = c == 2 * number % 3 ? 0.9F : 0.05F;
    scene.instances.push_back(
        {.model = scene.models.size(), .material = scene.materials.size(), .to_world = place});
    scene.models.push_back({.mesh = square});
    scene.materials.push_back(material);
}

glm::dmat4 turned(double angle, double up = 0.15) {
    return glm::rotate(glm::dmat4(1), angle, glm::dvec3(up, 1, 0));
}

struct Errors {
    double mean = 0;
    double largest = 0;
};

// Against an image of `finer` x `finer` pixels for each.
Errors errors_of(const oit::Scene& scene, const oit::Quality& quality, const oit::Reference& fine,
                 std::size_t finer) {
    constexpr std::size_t side = 40;
    const oit::Reference coarse =
        oit::draw_reference({.scene = scene,
                             .views = {support::frame_unit_sphere({0, 0}, static_cast<int>(side),
                                                                  static_cast<int>(side))},
                             .quality = quality});
    Errors errors;
    for (std::size_t p = 0; p < coarse.image.size(); ++p) {
        glm::dvec3 mean(0);
        for (std::size_t j = 0; j < finer; ++j)
            for (std::size_t i = 0; i < finer; ++i)
                mean += fine.image[(p / side * finer + j) * side * finer + p % side * finer + i];
        mean /= finer * finer;
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(coarse.image[p][c] - mean[c]);
            errors.mean += error / static_cast<double>(3 * coarse.image.size());
            errors.largest = std::max(errors.largest, error);
        }
    }
    return errors;
}

TEST_CASE("samples, and depths in each of them, bring the image nearer to one of many pixels") {
    std::vector<oit::Scene> scenes(4);
    // Two that stick in each other steeply, four that cross in one line, sheets that lie close
    // behind one another at a grazing angle and do not cross, and three in one corner.
    for (const double angle : {1.35, -1.35}) add_square_model(scenes[0], turned(angle));
    for (const double angle : {0.7, 0.58, 0.46, 0.35}) add_square_model(scenes[1], turned(angle));
    for (const double behind : {0.0, 0.02, 0.04, 0.06})
        add_square_model(scenes[2],
                         glm::translate(glm::dmat4(1), glm::dvec3(0, 0, behind)) * turned(1.4));
    for (const double up : {0.0, 0.9, -0.9}) add_square_model(scenes[3], turned(1.1, up));
    constexpr int finer = 12;
    for (const oit::Scene& scene : scenes) {
        const oit::Reference fine = oit::draw_reference(
            {.scene = scene,
             .views = {support::frame_unit_sphere({0, 0}, 40 * finer, 40 * finer)}});
        const Errors one = errors_of(scene, {.samples = 1}, fine, finer);
        const Errors eight = errors_of(scene, {.samples = 8}, fine, finer);
        const oit::Quality ordered{.samples = 8, .depth_range = true};
        const Errors depths = errors_of(scene, ordered, fine, finer);
        INFO("scene " << &scene - scenes.data() << ": mean errors " << one.mean << ", "
                      << eight.mean << ", " << depths.mean << "; largest " << eight.largest << ", "
                      << depths.largest);
        CHECK(eight.mean < 0.6 * one.mean);
        CHECK(depths.mean <= eight.mean);
        CHECK(depths.largest <= eight.largest);
        if (&scene != &scenes[2]) CHECK(depths.mean < 0.95 * eight.mean);
        // The device draws what the reference says.
        require_accurate_samples(sampled_frame(scene, ordered));
    }
}

TEST_CASE("two eyes are two views of one build") {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 240, 12), 0.35F);
    oit::add_floor(scene);
    const std::vector<raster::View> views = support::frame_unit_sphere({30, 10}, 90, 70, 0.25);
    const std::vector<cl_float4> both = require_accurate_samples({.scene = scene, .views = views});
    REQUIRE(both.size() == 2 * 90 * 70);
    for (std::size_t eye = 0; eye < 2; ++eye) {
        const std::vector<cl_float4> alone =
            require_accurate_samples({.scene = scene, .views = {views[eye]}});
        float largest = 0;
        for (std::size_t p = 0; p < alone.size(); ++p)
            for (int c = 0; c < 3; ++c)
                largest =
                    std::max(largest, std::abs(alone[p].s[c] - both[eye * alone.size() + p].s[c]));
        CHECK(largest == 0);
    }
}

}  // namespace
}  // namespace cellist::test
