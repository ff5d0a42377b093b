// SPDX-License-Identifier: MIT
// Under a bound on memory, lists are drawn in slices, and the picture is the same to the last bit.
#include <cstring>
#include <string>

#include "camera.hpp"
#include "input_error.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

constexpr const char* slicing[] = {"linked", "counted", "fixed", "adaptive"};

oit::Scene knot_on_floor() {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 200, 12), 0.3F);
    oit::add_floor(scene);
    return scene;
}

oit::Frame small_frame(const oit::Scene& scene, const oit::Quality& quality = {}, int eyes = 1) {
    const support::Orbit orbit{30, 10};
    if (eyes == 2)
        return {.scene = scene,
                .views = support::frame_unit_sphere(orbit, 40, 30, 0.1),
                .quality = quality};
    return {
        .scene = scene, .views = {support::frame_unit_sphere(orbit, 60, 45)}, .quality = quality};
}

oit::Frame bounded(oit::Frame frame, std::uint64_t bytes) {
    frame.memory_bytes = bytes;
    return frame;
}

std::string refusal(const oit::Frame& frame, const oit::MethodInfo& method) {
    oit::Renderer renderer(device(), frame, method);
    return error_of<support::InputError>([&] { renderer.draw(); }).what();
}

// What the refusal of a budget of one byte says to be enough.
std::uint64_t least_of(const oit::Frame& frame, const oit::MethodInfo& method) {
    const std::string message = refusal(bounded(frame, 1), method);
    const std::string mark = "it needs at least ";
    REQUIRE(contains(message, mark));
    return std::stoull(message.substr(message.find(mark) + mark.size()));
}

// Draws under several budgets. The greatest number of slices is returned.
std::uint32_t require_same(const oit::Frame& frame, const oit::MethodInfo& method) {
    INFO(method.name);
    oit::Renderer whole(device(), frame, method);
    whole.draw();
    const auto lengths = whole.method().lengths();
    const std::vector<cl_float4> expected = whole.image();
    const std::uint64_t least = least_of(frame, method);
    CHECK(contains(refusal(bounded(frame, least - 1), method), std::to_string(least)));
    std::uint32_t most = 0;
    for (const std::uint64_t bytes : {least + 3000, least + 50'000, std::uint64_t{1} << 30}) {
        INFO("budget of " << bytes << " bytes, " << least << " are enough");
        const oit::Frame tight = bounded(frame, bytes);
        oit::Renderer renderer(device(), tight, method);
        for (int run = 0; run < 2; ++run) {
            renderer.draw();
            CHECK(renderer.method().device_bytes() <= bytes);
            const std::vector<cl_float4> image = renderer.image();
            CHECK(std::memcmp(image.data(), expected.data(), expected.size() * sizeof(cl_float4)) ==
                  0);
        }
        CHECK(renderer.method().lengths()->histogram == lengths->histogram);
        most = std::max(most, renderer.method().slices());
        if (bytes == std::uint64_t{1} << 30) CHECK(renderer.method().slices() == 1);
    }
    return most;
}

TEST_CASE("pictures are the same whatever the budget of the lists is") {
    const oit::Scene scene = knot_on_floor();
    for (const char* name : slicing)
        CHECK(require_same(small_frame(scene), oit::method_named(name)) > 5);
}

TEST_CASE("slices go with eyes, samples, nearest layers and packed fragments") {
    const oit::Scene scene = knot_on_floor();
    const oit::MethodInfo& linked = oit::method_named("linked");
    CHECK(require_same(small_frame(scene, {.layers = 3}, 2), linked) > 5);
    CHECK(require_same(small_frame(scene, {.samples = 4,
                                           .resolve = oit::Resolve::per_sample,
                                           .format = oit::NodeFormat::rgba8_d24c8}),
                       linked) > 5);
}

TEST_CASE("the least budget that is named is enough") {
    const oit::Scene scene = knot_on_floor();
    const oit::Frame frame = small_frame(scene, {}, 2);
    const oit::MethodInfo& linked = oit::method_named("linked");
    const oit::Frame tight = bounded(frame, least_of(frame, linked));
    oit::Renderer whole(device(), frame, linked), renderer(device(), tight, linked);
    whole.draw();
    renderer.draw();
    CHECK(renderer.method().device_bytes() <= *tight.memory_bytes);
    CHECK(renderer.method().slices() > 100);
    const std::vector<cl_float4> expected = whole.image(), image = renderer.image();
    CHECK(std::memcmp(image.data(), expected.data(), expected.size() * sizeof(cl_float4)) == 0);
}

TEST_CASE("methods without slices draw within a budget, or say how much they take") {
    const oit::Scene scene = knot_on_floor();
    const oit::Frame frame = small_frame(scene);
    for (const char* name : {"kbuffer", "weighted", "peeling"}) {
        INFO(name);
        const oit::MethodInfo& method = oit::method_named(name);
        oit::Renderer whole(device(), frame, method);
        whole.draw();
        const std::uint64_t bytes = whole.method().device_bytes();
        CHECK(contains(refusal(bounded(frame, bytes - 1), method), std::to_string(bytes)));
        const oit::Frame enough = bounded(frame, bytes);
        oit::Renderer renderer(device(), enough, method);
        renderer.draw();
        const std::vector<cl_float4> expected = whole.image(), image = renderer.image();
        CHECK(std::memcmp(image.data(), expected.data(), expected.size() * sizeof(cl_float4)) == 0);
    }
}

TEST_CASE("nothing takes the memory of its pixels") {
    const oit::Scene empty;
    const oit::Frame frame = small_frame(empty);
    CHECK(require_same(frame, oit::method_named("linked")) == 1);
}

}  // namespace
}  // namespace cellist::test
