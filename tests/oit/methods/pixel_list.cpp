// SPDX-License-Identifier: MIT
// The list of one pixel: all its fragments, and the picture's pixel is what they blend to.
#include "methods/pixel_list.hpp"

#include <cmath>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/random_scene.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using oit::PixelFragment;

constexpr int list_width = 61, list_height = 45;

oit::Frame list_frame(const oit::Scene& scene, const oit::Quality& quality = {}) {
    return {.scene = scene,
            .views = support::frame_unit_sphere({30, 10}, list_width, list_height, 0.1),
            .quality = quality};
}

std::size_t pixel_index(int x, int y, std::size_t eye, int width, int height) {
    return (eye * static_cast<std::size_t>(height) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
}

TEST_CASE("a pixel's list is as long as the layers that are counted, nearest first") {
    const oit::Scene scene = random_scene(1, {oit::Blend::over, oit::Blend::opaque});
    for (const char* method : {"linked", "weighted", "kbuffer"}) {
        const oit::Frame frame = list_frame(scene);
        oit::Renderer renderer(device(), frame, oit::method_named(method));
        renderer.draw();
        const std::vector<cl_uint> layers = renderer.layers();
        for (std::size_t eye = 0; eye < 2; ++eye)
            for (const auto& [x, y] : {std::pair{0, 0}, {30, 22}, {25, 20}, {60, 44}, {40, 10}}) {
                INFO(method << ", eye " << eye << ", " << x << ", " << y);
                const std::vector<PixelFragment> list = renderer.fragments_at(x, y, eye);
                CHECK(list.size() == layers[pixel_index(x, y, eye, list_width, list_height)]);
                CHECK(std::ranges::is_sorted(list, {}, &PixelFragment::depth));
            }
    }
}

TEST_CASE("the fragments of a list blend to the pixel of the picture") {
    const oit::Scene scene = random_scene(2, {oit::Blend::over});  // without a floor
    const oit::Frame frame = list_frame(scene);
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const std::vector<cl_float4> image = renderer.image();
    const std::vector<cl_uint> layers = renderer.layers();
    int checked = 0;
    for (int y = 0; y < list_height; ++y)
        for (int x = 0; x < list_width && checked < 20; ++x) {
            const std::size_t pixel = pixel_index(x, y, 0, list_width, list_height);
            // The background is the same along a row.
            const std::size_t behind = pixel_index(0, y, 0, list_width, list_height);
            if (layers[pixel] < 4 || layers[behind] > 0) continue;
            ++checked;
            INFO(x << ", " << y);
            const std::vector<PixelFragment> list = renderer.fragments_at(x, y, 0);
            for (int channel = 0; channel < 3; ++channel) {
                double blended = 0, passes = 1;
                for (const PixelFragment& fragment : list) {
                    const auto alpha = static_cast<double>(fragment.alpha);
                    blended += passes * alpha * static_cast<double>(fragment.colour[channel]);
                    passes *= 1 - alpha;
                }
                blended += passes * static_cast<double>(image[behind].s[channel]);
                CHECK(std::abs(blended - static_cast<double>(image[pixel].s[channel])) < 1e-5);
            }
        }
    CHECK(checked == 20);
}

TEST_CASE("with reduced transparent surfaces, a list is that of the larger pixel") {
    const oit::Scene scene = random_scene(2, {oit::Blend::over});
    const oit::Frame frame = list_frame(scene, {.reduce = 2});
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const std::vector<cl_uint> layers = renderer.layers();
    const oit::Frame& drawn = renderer.drawn_frame();
    for (const auto& [x, y] : {std::pair{31, 23}, {30, 22}, {60, 44}})
        CHECK(renderer.fragments_at(x, y, 1).size() ==
              layers[pixel_index(x / 2, y / 2, 1, drawn.width(), drawn.height())]);
}

}  // namespace
}  // namespace cellist::test
