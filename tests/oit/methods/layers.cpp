// SPDX-License-Identifier: MIT
// The layers of each pixel are those of the reference, whatever the method stores.
#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/random_scene.hpp"
#include "reference/reference.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

std::vector<raster::View> two_eyes() { return support::frame_unit_sphere({30, 10}, 61, 45, 0.1); }

void require_layers_of_reference(const oit::Frame& frame, const oit::MethodInfo& method) {
    INFO(method.name << ", " << frame.quality.samples << " samples, 1/" << frame.quality.reduce);
    if (!method.refusal(frame, oit::features_of(frame)).empty()) return;
    oit::Renderer renderer(device(), frame, method);
    renderer.draw();
    const std::vector<std::uint32_t> expected =
        oit::draw_reference(renderer.drawn_frame()).layers();
    CHECK(std::ranges::max(expected) > 3);
    CHECK(renderer.layers() == expected);
    CHECK(renderer.layers() == expected);  // counting changes nothing
    const std::vector<cl_float4> image = renderer.image();
    renderer.draw();
    CHECK(std::ranges::equal(image, renderer.image(), [](const cl_float4& a, const cl_float4& b) {
        return std::ranges::equal(a.s, b.s);
    }));
}

TEST_CASE("every method counts all layers in front of opaque surfaces, of both eyes") {
    oit::Scene scene = random_scene(1, {oit::Blend::over, oit::Blend::opaque});
    const oit::Frame frame{.scene = scene, .views = two_eyes()};
    for (const oit::MethodInfo& method : oit::methods()) require_layers_of_reference(frame, method);
}

TEST_CASE("layers are counted once for all samples, in slices, and whatever is blended") {
    const oit::Scene scene = random_scene(3, {oit::Blend::over});
    const oit::MethodInfo& linked = oit::method_named("linked");
    for (const oit::Quality& quality : {oit::Quality{.samples = 4},
                                        {.samples = 4, .resolve = oit::Resolve::per_sample},
                                        {.layers = 2},
                                        {.epsilon = 0.5F},
                                        {.format = oit::NodeFormat::rgba8}}) {
        oit::Frame frame{.scene = scene, .views = two_eyes(), .quality = quality};
        require_layers_of_reference(frame, linked);
        frame.memory_bytes = 200'000;
        require_layers_of_reference(frame, linked);
    }
}

TEST_CASE("with reduced transparent surfaces, the layers are those of the reduced picture") {
    const oit::Scene scene = random_scene(2, {oit::Blend::over});
    for (const int reduce : {2, 4}) {
        const oit::Frame frame{.scene = scene, .views = two_eyes(), .quality = {.reduce = reduce}};
        require_layers_of_reference(frame, oit::method_named("linked"));
        require_layers_of_reference(frame, oit::method_named("weighted"));
    }
}

}  // namespace
}  // namespace cellist::test
