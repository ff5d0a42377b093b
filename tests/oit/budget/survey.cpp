// SPDX-License-Identifier: MIT
// What a survey promises of a picture holds against the reference in double precision.
#include "budget/survey.hpp"

#include <algorithm>
#include <cmath>

#include "camera.hpp"
#include "image.hpp"
#include "methods/renderer.hpp"
#include "oit/support/random_scene.hpp"
#include "reference/reference.hpp"
#include "scene/scenes.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using oit::Blend;
using oit::PictureError;

const std::vector<std::uint32_t> layer_counts{1, 2, 4, 8, 16};
const std::vector<float> epsilons{0.1F, 0.01F};

oit::Frame survey_frame(const oit::Scene& scene, const oit::Quality& quality = {}) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 100, 75)},
            .quality = quality};
}

// Errors of a picture in the pixels whose order of layers is resolved, and in all.
struct Measured {
    PictureError resolved, all;
};

Measured measure(const oit::Reference& reference, const std::vector<cl_float4>& image) {
    Measured measured;
    const auto channels = 3 * static_cast<double>(image.size());
    for (std::size_t p = 0; p < image.size(); ++p)
        for (int c = 0; c < 3; ++c) {
            const double error =
                std::abs(support::srgb_from_linear(static_cast<double>(image[p].s[c])) -
                         support::srgb_from_linear(reference.image[p][c]));
            const auto add = [&](PictureError& to) {
                to.largest = std::max(to.largest, error);
                to.mean_square += error * error / channels;
            };
            add(measured.all);
            if (!reference.ambiguous[p]) add(measured.resolved);
        }
    return measured;
}

void require_within(const PictureError& error, const PictureError& bound, const std::string& what) {
    INFO(what << ": largest " << 255 * error.largest << "/255, bound " << 255 * bound.largest
              << "/255; mean square " << error.mean_square << ", bound " << bound.mean_square);
    CHECK(error.largest <= bound.largest);
    CHECK(error.mean_square <= bound.mean_square);
}

// Draws the frame in all formats and with all cuts.
void require_bounds(const oit::Frame& frame) {
    oit::Survey survey(device(), frame, layer_counts, epsilons);
    const oit::SurveyResult bounds = survey.measure(frame);
    const oit::Reference reference = oit::draw_reference(frame);
    std::uint64_t longest = 0;
    for (std::size_t p = 0; p + 1 < reference.offsets.size(); ++p)
        longest = std::max(longest, reference.offsets[p + 1] - reference.offsets[p]);
    const auto count = static_cast<double>(reference.fragments.size());
    CHECK(std::abs(static_cast<double>(bounds.fragments) - count) <= 1e-3 * count);
    CHECK(bounds.longest <= longest + 1);

    const auto require_drawn = [&](const oit::Quality& quality, const PictureError& bound,
                                   const std::string& what) {
        oit::Frame other = frame;
        other.quality = quality;
        oit::Renderer renderer(device(), other);
        renderer.draw();
        const Measured is = measure(reference, renderer.image());
        require_within(is.resolved, bound, what);
        const oit::PictureErrors compared = survey.compare(renderer.picture());
        require_within(is.resolved, compared.resolved, what + ", compared");
        require_within(is.all, compared.all, what + ", compared, with any order");
    };
    for (const oit::NodeFormatName& format : oit::node_formats) {
        oit::Quality quality = frame.quality;
        quality.format = format.format;
        require_drawn(quality, bounds.format(format.format), std::string(format.name));
    }
    for (const oit::SurveyResult::Cut& cut : bounds.cuts) {
        oit::Quality quality = frame.quality;
        if (cut.layers > 0) quality.layers = cut.layers;
        quality.epsilon = cut.epsilon;
        require_drawn(quality, cut.error,
                      cut.layers > 0 ? std::to_string(cut.layers) + " layers"
                                     : "epsilon " + std::to_string(cut.epsilon));
    }
}

TEST_CASE("bounds hold for random scenes that cover and add") {
    for (const std::uint32_t seed : {1u}) {
        INFO("seed " << seed);
        const oit::Scene scene = random_scene(seed, {Blend::over, Blend::additive, Blend::over});
        require_bounds(survey_frame(scene));
    }
}

TEST_CASE("bounds hold for random scenes that filter and absorb") {
    for (const std::uint32_t seed : {4u}) {
        INFO("seed " << seed);
        const oit::Scene scene =
            random_scene(seed, {Blend::absorb, Blend::multiplicative, Blend::over});
        require_bounds(survey_frame(scene));
    }
}

TEST_CASE("bounds hold for samples and ranges of depth") {
    const oit::Scene scene = random_scene(7, {Blend::over, Blend::over});
    require_bounds(survey_frame(scene, {.samples = 4}));
    require_bounds(survey_frame(scene, {.samples = 2, .depth_range = true}));
}

// Thin triangles across the picture: few fragments, and many blocks of pixels that they touch.
oit::Scene splinters(int count) {
    support::Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(count);
        const float y = 1.2F * part - 0.6F, z = 0.5F * std::sin(100 * part);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(),
                              {{-0.9F, y, z}, {0.9F, y, z}, {0.9F, y + 2e-3F, z}});
        mesh.normals.insert(mesh.normals.end(), 3, {0, 0, 1});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return oit::scene_of(mesh, 0.3F);
}

TEST_CASE("a survey misses nothing where its first room is too small") {
    const oit::Scene scene = splinters(10000);
    const oit::Frame frame = survey_frame(scene);
    oit::Survey survey(device(), frame, layer_counts, epsilons);
    const auto found = static_cast<double>(survey.measure(frame).fragments);
    const auto count = static_cast<double>(oit::draw_reference(frame).fragments.size());
    CHECK(count > 1000);
    CHECK(std::abs(found - count) <= 1e-3 * count);
}

TEST_CASE("bounds hold at the limits of numbers") {
    for (const oit::SceneInfo& info : oit::scenes()) {
        if (!info.name.starts_with("extreme-")) continue;
        INFO(info.name);
        const oit::Scene scene = info.make(0.35F);
        const oit::Frame frame = survey_frame(scene);
        oit::Survey survey(device(), frame, layer_counts, epsilons);
        const oit::SurveyResult bounds = survey.measure(frame);
        const oit::Reference reference = oit::draw_reference(frame);
        oit::Renderer renderer(device(), frame);
        renderer.draw();
        const Measured is = measure(reference, renderer.image());
        require_within(is.resolved, bounds.exact, "all layers");
        require_within(is.all, bounds.exact_with_order, "all layers, with any order");
    }
}

}  // namespace
}  // namespace cellist::test
