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
    const oit::Scene scene = random_scene(3, {oit::Blend::over});
    const oit::Frame frame = list_frame(scene);
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const std::vector<cl_float4> image = renderer.image();
    int long_lists = 0;
    for (const auto& [x, y] : {std::pair{30, 22}, {25, 20}, {35, 25}, {28, 30}}) {
        INFO(x << ", " << y);
        const std::vector<PixelFragment> list = renderer.fragments_at(x, y, 0);
        long_lists += list.size() > 3 ? 1 : 0;
        // The background is the same along a row; nothing is in front of it at the row's end.
        REQUIRE(renderer.fragments_at(0, y, 0).empty());
        for (int channel = 0; channel < 3; ++channel) {
            const auto value_at = [&](int column) {
                return static_cast<double>(
                    image[pixel_index(column, y, 0, list_width, list_height)].s[channel]);
            };
            double blended = 0, passes = 1;
            for (const PixelFragment& fragment : list) {
                blended += passes * static_cast<double>(fragment.alpha) *
                           static_cast<double>(fragment.colour[channel]);
                passes *= 1 - static_cast<double>(fragment.alpha);
            }
            CHECK(std::abs(blended + passes * value_at(0) - value_at(x)) < 1e-5);
        }
    }
    CHECK(long_lists > 0);
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
