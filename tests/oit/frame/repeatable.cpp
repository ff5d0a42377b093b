// SPDX-License-Identifier: MIT
// The same frame is the same bits, run after run.
#include <algorithm>
#include <cstring>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

std::vector<cl_float4> draw_repeatedly(const support::Mesh& mesh,
                                       std::optional<std::uint32_t> layers, int runs,
                                       int& different) {
    oit::Scene scene = oit::scene_of(mesh, 0.35F);
    oit::add_floor(scene);
    const oit::Frame frame{.scene = scene,
                           .views = {support::frame_unit_sphere({25, 8}, 320, 240)},
                           .quality = {.layers = layers}};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const std::vector<cl_float4> first = renderer.image();
    for (int run = 1; run < runs; ++run) {
        renderer.draw();
        const std::vector<cl_float4> image = renderer.image();
        if (std::memcmp(image.data(), first.data(), image.size() * sizeof(cl_float4)) != 0)
            ++different;
    }
    return first;
}

TEST_CASE("twenty runs give the same bits") {
    const support::Mesh knot = torus_knot(3, 7, 500, 16);
    for (const std::optional<std::uint32_t> layers :
         {std::optional<std::uint32_t>(), std::optional<std::uint32_t>(3)}) {
        int different = 0;
        draw_repeatedly(knot, layers, 20, different);
        CHECK(different == 0);
    }
}

TEST_CASE("the order of the triangles does not matter, coincident ones included") {
    support::Mesh knot = torus_knot(2, 3, 300, 12);
    // The same surface again, turned inside out: equal depths in every pixel.
    const std::size_t count = knot.triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
        const auto t = knot.triangles[i];
        knot.triangles.push_back({t[0], t[2], t[1]});
    }
    int different = 0;
    const std::vector<cl_float4> forwards = draw_repeatedly(knot, {}, 1, different);
    std::reverse(knot.triangles.begin(), knot.triangles.end());
    const std::vector<cl_float4> backwards = draw_repeatedly(knot, {}, 1, different);
    CHECK(std::memcmp(forwards.data(), backwards.data(), forwards.size() * sizeof(cl_float4)) == 0);
}

}  // namespace
}  // namespace cellist::test
