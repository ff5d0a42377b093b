// SPDX-License-Identifier: MIT
// Nodes of every format hold what they promise, in as few words as the frame allows.
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/node_errors.hpp"
#include "oit/support/procedural.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using oit::NodeFormat;

oit::Frame format_frame(const oit::Scene& scene, const oit::Quality& quality) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 160, 120)},
            .quality = quality};
}

// Requires that pixels in which depths are resolved are within the bound that follows from the
// format's, and returns how many these are.
std::size_t require_within_bound(const oit::Scene& scene, const oit::Quality& quality) {
    const oit::Frame frame = format_frame(scene, quality);
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const oit::Reference reference = oit::draw_reference(frame);
    const std::vector<cl_float4> image = renderer.image();
    const auto lengths = renderer.method().lengths();
    REQUIRE(lengths->total == reference.fragments.size());
    // An error of an opacity counts once for each layer, up to the brightest colour.
    const double bound = colour_error(renderer.layout(), renderer.features()) +
                         static_cast<double>(lengths->longest) * alpha_error(renderer.layout()) *
                             static_cast<double>(renderer.features().colour_max) +
                         1e-5;
    std::size_t certain = 0, wrong = 0;
    double largest = 0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        if (reference.ambiguous[p]) continue;
        ++certain;
        double error = 0;
        for (int c = 0; c < 3; ++c)
            error = std::max(error,
                             std::abs(static_cast<double>(image[p].s[c]) - reference.image[p][c]));
        largest = std::max(largest, error);
        if (!(error <= bound)) ++wrong;
    }
    INFO("largest error " << largest << ", bound " << bound << ", " << certain << " pixels");
    CHECK(wrong == 0);
    return certain;
}

oit::Scene plain_knot() { return oit::scene_of(torus_knot(2, 3, 300, 16), 0.35F); }

// Opacities that differ from vertex to vertex.
oit::Scene smoky_knot() {
    oit::Scene scene = plain_knot();
    oit::Model& model = scene.models.front();
    for (std::size_t i = 0; i < model.mesh.positions.size(); ++i)
        model.opacities.push_back(static_cast<float>(i % 100) / 99);
    return scene;
}

TEST_CASE("a node has no more words than the frame needs") {
    struct Case {
        NodeFormat format;
        std::uint32_t uniform, smoky, smoky_samples;
    };
    for (const Case& c : {Case{NodeFormat::float32, 4, 5, 6},
                          {NodeFormat::rgba8, 2, 2, 3},
                          {NodeFormat::rgba16f, 3, 3, 4},
                          {NodeFormat::rgba8_d24c8, 2, 2, 2},
                          {NodeFormat::rgb565_d16, 1, 2, 2}}) {
        INFO("format " << static_cast<int>(c.format));
        const auto words = [&](const oit::Scene& scene, int samples) {
            const oit::Quality quality{.samples = samples, .format = c.format};
            return node_layout(quality, features_of(format_frame(scene, quality))).words;
        };
        CHECK(words(plain_knot(), 1) == c.uniform);
        CHECK(words(smoky_knot(), 1) == c.smoky);
        CHECK(words(smoky_knot(), 8) == c.smoky_samples);
    }
}

TEST_CASE("there are types of nodes of 1 to 7 words, and no others") {
    const auto bytes_of = [](std::uint32_t words) {
        return oit::with_node_type(
            words, []<class Node>(const Node*) -> std::size_t { return sizeof(Node); });
    };
    for (std::uint32_t words = 1; words <= 7; ++words) CHECK(bytes_of(words) == 4 * words);
    CHECK_THROWS_AS(bytes_of(0), std::out_of_range);
    CHECK_THROWS_AS(bytes_of(8), std::out_of_range);
}

TEST_CASE("every format is as accurate as its bound") {
    for (const oit::NodeFormatName& format : oit::node_formats)
        for (const oit::DepthScale scale : {oit::DepthScale::linear, oit::DepthScale::reversed})
            for (const bool smoky : {false, true}) {
                INFO(format.name << ", "
                                 << (scale == oit::DepthScale::linear ? "linear" : "reversed")
                                 << (smoky ? ", with opacities" : ""));
                const std::size_t certain =
                    require_within_bound(smoky ? smoky_knot() : plain_knot(),
                                         {.format = format.format, .depth_scale = scale});
                CHECK(certain > 160 * 120 * 9 / 10);
            }
}

TEST_CASE("formats hold coverage and kinds of blending, too") {
    oit::Scene scene = smoky_knot();
    oit::Material filter = oit::glass(0.5F);
    filter.blend = static_cast<cl_uint>(oit::Blend::multiplicative);
    scene.materials.push_back(filter);
    scene.instances.push_back({.material = 1});
    scene.instances.back().to_world[3].x = 0.3;
    for (const oit::NodeFormatName& format : oit::node_formats) {
        INFO(format.name);
        require_within_bound(scene, {.samples = 4, .format = format.format});
    }
}

TEST_CASE("depths in nodes are as fine as they are said to be") {
    const oit::Scene scene = plain_knot();
    for (const oit::NodeFormatName& format : oit::node_formats)
        for (const oit::DepthScale scale : {oit::DepthScale::linear, oit::DepthScale::reversed}) {
            INFO(format.name);
            const oit::Frame frame =
                format_frame(scene, {.format = format.format, .depth_scale = scale});
            oit::Renderer renderer(device(), frame);
            renderer.draw();
            const oit::Reference reference = oit::draw_reference(frame);
            const auto stored = renderer.method().depths();
            REQUIRE(stored->depths.size() == reference.fragments.size());
            std::size_t wrong = 0;
            for (std::size_t p = 0; p + 1 < stored->offsets.size(); ++p) {
                std::vector<double> depths(
                    stored->depths.begin() + static_cast<std::ptrdiff_t>(stored->offsets[p]),
                    stored->depths.begin() + static_cast<std::ptrdiff_t>(stored->offsets[p + 1]));
                std::sort(depths.begin(), depths.end());
                for (std::size_t i = 0; i < depths.size(); ++i) {
                    const double depth = reference.fragments[reference.offsets[p] + i].depth;
                    if (std::abs(depths[i] - depth) >
                        renderer.layout().depth_resolution(renderer.features()).at(depth))
                        ++wrong;
                }
            }
            CHECK(wrong == 0);
        }
}

}  // namespace
}  // namespace cellist::test
