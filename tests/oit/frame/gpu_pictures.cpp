// SPDX-License-Identifier: MIT
// Pictures are the same bits if work-groups draw, as on GPUs, as if work-items do, as on
// processors.
#include <cstring>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/internals.hpp"

namespace cellist::test {
namespace {

// Of frames from nearer and nearer and back again: at first, all triangles are small, and at last,
// the eye is among them.
std::vector<std::vector<cl_float4>> draw(const Device& device, const oit::Scene& scene,
                                         const oit::Quality& quality) {
    oit::Frame frame{.scene = scene, .views = {}, .quality = quality};
    const auto look = [&](double zoom) {
        frame.views =
            support::frame_unit_sphere({.azimuth_degrees = 25, .zoom = zoom}, 96, 64, 0.1);
    };
    look(1);
    oit::Renderer renderer(device, frame);
    renderer.warm_up();
    std::vector<std::vector<cl_float4>> pictures;
    for (const double zoom : {1.0, 1.0, 4.0, 40.0, 1.0, 1.0, 1.0}) {
        look(zoom);
        renderer.draw_changed();
        pictures.push_back(renderer.image());
    }
    return pictures;
}

void require_same(const oit::Scene& scene, const oit::Quality& quality) {
    static const Device gpu = like_gpu();
    const auto expected = draw(device(), scene, quality);
    const auto pictures = draw(gpu, scene, quality);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        INFO("picture " << i);
        const std::size_t bytes = expected[i].size() * sizeof(cl_float4);
        REQUIRE(pictures[i].size() == expected[i].size());
        CHECK(std::memcmp(pictures[i].data(), expected[i].data(), bytes) == 0);
    }
}

TEST_CASE("GPUs draw few and many transparent triangles as processors do") {
    for (const int around : {12, 40}) {  // 2400 and 8000 triangles
        INFO(around << " around");
        require_same(oit::scene_of(torus_knot(2, 3, 100, around), 0.3F), {});
        require_same(oit::scene_of(torus_knot(2, 3, 100, around), 0.3F), {.samples = 4});
    }
}

TEST_CASE("GPUs draw transparent triangles before opaque ones as processors do") {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 100, 12), 0.3F);
    oit::add_floor(scene);
    require_same(scene, {});
    require_same(scene, {.samples = 2, .resolve = oit::Resolve::per_sample});
    require_same(scene, {.coverage = oit::Coverage::exact});
}

}  // namespace
}  // namespace cellist::test
