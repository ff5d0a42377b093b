// SPDX-License-Identifier: MIT
// Settings are those that a frame can have, and measuring one tells what it costs and gives.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "budget/measurement.hpp"
#include "camera.hpp"
#include "oit/support/procedural.hpp"
#include "options.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"
#include "tradeoff/sweep.hpp"

namespace cellist::test {
namespace {

oit::Scene blended_knot(oit::Blend blend = oit::Blend::over) {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 150, 10), 0.4F);
    scene.materials.front().blend = static_cast<cl_uint>(blend);
    return scene;
}

oit::Frame settings_frame(const oit::Scene& scene, const oit::Quality& quality = {}) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 80, 60)},
            .quality = quality};
}

std::vector<std::string> texts_of(const std::vector<oit::Setting>& settings) {
    std::vector<std::string> texts;
    for (const oit::Setting& setting : settings) texts.push_back(text(setting));
    return texts;
}

bool has(const std::vector<std::string>& texts, const std::string& text) {
    return std::ranges::find(texts, text) != texts.end();
}

TEST_CASE("settings are all different, and cover methods, formats, layers, early ends and sizes") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(scene);
    const std::vector<std::string> texts = texts_of(settings_for(frame, 20));
    CHECK(std::set<std::string>(texts.begin(), texts.end()).size() == texts.size());
    for (const oit::MethodInfo& method : oit::methods()) {
        if (!method.refusal(frame, features_of(frame)).empty()) continue;
        INFO(method.name);
        CHECK(std::ranges::is_sorted(method.sizes));
        CHECK(std::ranges::any_of(texts, [&](const std::string& text) {
            return text.starts_with("--method " + std::string(method.name));
        }));
        for (const oit::NodeFormatName& format : oit::node_formats)
            if (method.exact && format.format != oit::NodeFormat::float32)
                CHECK(has(texts, "--method " + std::string(method.name) + " --format " +
                                     std::string(format.name)));
    }
    for (const std::string text :
         {"--method linked", "--method linked --layers 1", "--method linked --layers 16",
          "--method linked --epsilon 0.1", "--method adaptive:4", "--method weighted"})
        CHECK(has(texts, text));
    CHECK_FALSE(has(texts, "--method linked --layers 32"));
}

TEST_CASE("settings through a lens cover its methods, layers and numbers of rays") {
    const oit::Scene scene = blended_knot();
    oit::Frame frame = settings_frame(scene);
    frame.lens = oit::Lens{.radius = 0.1, .focus = 4};
    const std::vector<std::string> texts = texts_of(settings_for(frame, 20));
    CHECK(std::set<std::string>(texts.begin(), texts.end()).size() == texts.size());
    for (const std::string text :
         {"--method linked", "--method linked --layers 1", "--method linked --layers 16",
          "--method linked --lens-rays 8", "--method linked --lens-rays 128", "--method counted",
          "--method kbuffer:8", "--method blur", "--method peeled:1", "--method peeled:16",
          "--method positions:8", "--method positions:256"})
        CHECK(has(texts, text));
    for (const std::string& text : texts) {
        CHECK_FALSE(contains(text, "weighted"));
        CHECK_FALSE(contains(text, "epsilon"));
    }
}

TEST_CASE("settings with exact coverage have all layers") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(scene, {.coverage = oit::Coverage::exact});
    const std::vector<oit::Setting> settings = settings_for(frame, 20);
    CHECK(has(texts_of(settings), "--method linked --epsilon 0.1 --samples exact"));
    for (const oit::Setting& setting : settings) CHECK_FALSE(setting.quality.layers);
}

TEST_CASE("settings that a method refuses are left out") {
    const oit::Scene scene = blended_knot(oit::Blend::absorb);
    const oit::Frame frame = settings_frame(scene);
    for (const std::string& text : texts_of(settings_for(frame, 100))) {
        CHECK_FALSE(contains(text, "weighted"));
        CHECK_FALSE(contains(text, "dual_peeling"));
    }
}

TEST_CASE("settings keep a frame's samples, and nothing that it gives up") {
    const oit::Scene scene = blended_knot();
    const auto settings = settings_for(
        settings_frame(scene, {.samples = 4, .resolve = oit::Resolve::per_sample, .layers = 2}), 3);
    CHECK(has(texts_of(settings), "--method linked --samples 4 --resolve sample"));
    for (const oit::Setting& setting : settings) CHECK(setting.quality.samples == 4);
}

TEST_CASE("the exact setting is the first, and nothing of a frame's but its samples and depths") {
    const oit::Scene scene = blended_knot();
    const oit::Quality quality{.samples = 4,
                               .resolve = oit::Resolve::per_sample,
                               .depth_range = true,
                               .format = oit::NodeFormat::rgba8,
                               .depth_scale = oit::DepthScale::reversed,
                               .layers = 3,
                               .epsilon = 0.1F,
                               .size = 8};
    const oit::Setting exact = oit::exact_setting(quality);
    CHECK(oit::text(exact) ==
          "--method linked --depth-scale reversed --samples 4 --resolve sample --depth-range");
    CHECK(oit::text(settings_for(settings_frame(scene, quality), 20).front()) == oit::text(exact));
}

TEST_CASE("the text of a setting is read as that setting") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(
        scene, {.samples = 2, .depth_range = true, .depth_scale = oit::DepthScale::reversed});
    for (const oit::Setting& setting : settings_for(frame, 100)) {
        std::istringstream words("cellist-oit gearworks " + text(setting));
        std::vector<std::string> arguments;
        for (std::string word; words >> word;) arguments.push_back(word);
        std::vector<const char*> pointers;
        for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
        const oit::Options options =
            oit::parse_options(static_cast<int>(pointers.size()), pointers.data());
        CHECK(oit::text({&oit::method_named(options.method), options.quality}) ==
              oit::text(setting));
        CHECK(options.quality.epsilon == setting.quality.epsilon);
    }
}

TEST_CASE("options that are not given are as they were") {
    const char* const arguments[] = {"cellist-oit", "smoke"};
    const oit::Options read = oit::parse_options(2, arguments), usual;
    CHECK(read.quality == usual.quality);
    CHECK(read.alpha == usual.alpha);
    CHECK(read.orbit.azimuth_degrees == usual.orbit.azimuth_degrees);
    CHECK(read.orbit.elevation_degrees == usual.orbit.elevation_degrees);
    CHECK(read.width == usual.width);
    CHECK(read.frames == usual.frames);
    CHECK(read.check_every == usual.check_every);
    CHECK_FALSE(read.blend);
    CHECK_FALSE(read.eye_separation);
}

TEST_CASE("larger sizes of an approximation are not less accurate") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(scene);
    const oit::Reference reference = oit::draw_reference(frame);
    for (const oit::MethodInfo& method : oit::methods()) {
        if (method.sizes.empty() || !method.refusal(frame, features_of(frame)).empty()) continue;
        INFO(method.name);
        const auto measured = [&](std::uint32_t size) {
            return measure(device(), frame, {&method, {.size = size}}, reference, 1);
        };
        const oit::Measurement least = measured(method.sizes.front());
        const oit::Measurement most = measured(method.sizes.back());
        REQUIRE(least.drawn());
        REQUIRE(most.drawn());
        CHECK(most.bytes >= least.bytes);
        CHECK(most.comparison.psnr_db >= least.comparison.psnr_db);
        CHECK(most.comparison.ssim >= least.comparison.ssim);
        if (method.exact) CHECK(least.comparison.psnr_db > 100);
    }
}

TEST_CASE("a measurement has times, memory, errors and the image") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(scene);
    const oit::Reference reference = oit::draw_reference(frame);
    const oit::MethodInfo& linked = oit::method_named("linked");
    const oit::Measurement all = measure(device(), frame, {&linked, {}}, reference, 3);
    REQUIRE(all.drawn());
    CHECK(all.times.size() == 3);
    CHECK(all.fastest > 0);
    CHECK(all.fastest <= all.milliseconds);
    CHECK(all.bytes > 0);
    CHECK(all.image.size() == frame.pixels());
    CHECK(all.comparison.psnr_db > 100);
    CHECK(all.comparison.ssim > 0.999999);
    // Against the reference of all layers.
    const oit::Measurement one = measure(device(), frame, {&linked, {.layers = 1}}, reference, 1);
    CHECK(one.comparison.psnr_db < 40);
    CHECK(one.comparison.ssim < 0.99);
}

TEST_CASE("settings are measured interleaved, each with as many frames") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(scene);
    const oit::Reference reference = oit::draw_reference(frame);
    const std::vector<oit::Setting> settings{{&oit::method_named("linked"), {}},
                                             {&oit::method_named("dual_peeling"), {.layers = 3}},
                                             {&oit::method_named("weighted"), {}}};
    for (const std::uint32_t frames : {1U, 2U, 5U}) {
        std::vector<std::string> names;
        double done = 0;
        const std::vector<oit::Measurement> measurements = oit::measure_interleaved(
            device(), frame, reference, settings, frames,
            [&](oit::Measurement& measurement) {
                names.emplace_back(measurement.setting.method->name);
                CHECK(measurement.times.size() <= 2);
                CHECK(measurement.image.empty() == !measurement.drawn());
            },
            [&](double part) {
                CHECK(part >= done);
                CHECK(part < 1);
                done = part;
            });
        CHECK(names == std::vector<std::string>{"linked", "dual_peeling", "weighted"});
        CHECK((done > 0) == (frames > 1));
        REQUIRE(measurements.size() == 3);
        CHECK(measurements[0].times.size() == frames);
        CHECK_FALSE(measurements[1].drawn());
        CHECK(measurements[1].times.empty());
        CHECK(measurements[2].times.size() == frames);
        CHECK(measurements[2].comparison.psnr_db > 20);
    }
}

TEST_CASE("what cannot be drawn has a reason and no metrics") {
    const oit::Scene scene = blended_knot();
    const oit::Frame frame = settings_frame(scene);
    const oit::Setting refused{&oit::method_named("dual_peeling"), {.layers = 3}};
    const oit::Measurement measurement =
        measure(device(), frame, refused, oit::draw_reference(frame), 2);
    CHECK_FALSE(measurement.drawn());
    CHECK(contains(measurement.failure, "farthest"));
    CHECK(measurement.times.empty());
    CHECK(measurement.image.empty());
}

}  // namespace
}  // namespace cellist::test
