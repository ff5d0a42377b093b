// SPDX-License-Identifier: MIT
// Every method of the table draws what it promises.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "camera.hpp"
#include "methods/method.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "reference/comparison.hpp"
#include "scene/scenes.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

using oit::Blend;

// Two knots in one another on a floor, and a copy of one of them in the same place.
oit::Scene nested_knots(Blend inner) {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 200, 12), 0.3F);
    oit::Material material = oit::glass(0.6F);
    material.blend = static_cast<cl_uint>(inner);
    scene.materials.push_back(material);
    scene.instances.push_back({.to_world = glm::scale(glm::dmat4(1), glm::dvec3(0.8))});
    scene.instances.push_back(
        {.material = 1, .to_world = glm::scale(glm::dmat4(1), glm::dvec3(0.8))});
    oit::add_floor(scene);
    return scene;
}

oit::Frame knots_frame(const oit::Scene& scene, const oit::Quality& quality = {}) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 150, 110)},
            .quality = quality};
}

// Whether the method refuses the frame. Notes the reason.
bool is_refused(const oit::MethodInfo& method, const oit::Frame& frame) {
    const std::string refusal = method.refusal(frame, oit::features_of(frame));
    if (!refusal.empty()) note_skip(std::string(method.name) + ": " + refusal);
    return !refusal.empty();
}

void require_exact(const oit::MethodInfo& method, const oit::Frame& frame) {
    if (is_refused(method, frame)) return;
    oit::Renderer renderer(device(), frame, method);
    renderer.draw();
    renderer.draw();
    const oit::Comparison comparison =
        oit::compare(oit::draw_reference(frame), renderer.image(), renderer.method().depths());
    INFO(method.name << ": " << 255 * comparison.max_abs_error << "/255");
    CHECK(comparison.pixels_over == comparison.pixels_explained);
    CHECK(comparison.pixels_nan == 0);
    CHECK(comparison.pixels_with_other_count == 0);
    CHECK(renderer.method().device_bytes() > 0);
}

TEST_CASE("exact methods blend all fragments") {
    // Interleaved: methods share the code that blends.
    constexpr std::array blends{Blend::over, Blend::multiplicative, Blend::absorb};
    std::size_t turn = 0;
    for (const oit::MethodInfo& method : oit::methods())
        if (method.exact)
            require_exact(method, knots_frame(nested_knots(blends[turn++ % blends.size()])));
}

TEST_CASE("exact methods blend samples, nearest layers and packed fragments") {
    const oit::Scene scene = nested_knots(Blend::additive);
    for (const oit::MethodInfo& method : oit::methods()) {
        if (!method.exact) continue;
        require_exact(method, knots_frame(scene, {.samples = 4}));
        require_exact(method, knots_frame(scene, {.layers = 3}));
    }
}

TEST_CASE("every method gives the same bits every time, and no colour that is no number") {
    const oit::Scene scene = nested_knots(Blend::over);
    const oit::Frame frame = knots_frame(scene);
    for (const oit::MethodInfo& method : oit::methods()) {
        if (is_refused(method, frame)) continue;
        INFO(method.name);
        oit::Renderer renderer(device(), frame, method);
        renderer.draw();
        const std::vector<cl_float4> first = renderer.image();
        CHECK(oit::count_nan(first) == 0);
        for (int run = 0; run < 5; ++run) {
            renderer.draw();
            const std::vector<cl_float4> image = renderer.image();
            CHECK(std::memcmp(image.data(), first.data(), image.size() * sizeof(cl_float4)) == 0);
        }
    }
}

// What an approximation makes of a single layer is exact, and of many it is near the truth.
TEST_CASE("approximations are exact where there is one layer, and near where there are more") {
    const oit::Scene many = nested_knots(Blend::over);
    for (const oit::MethodInfo& method : oit::methods()) {
        if (method.exact || is_refused(method, knots_frame(many))) continue;
        for (const int samples : {1, 4}) {
            INFO(method.name << ", " << samples << " samples");
            const auto psnr = [&](const oit::Scene& scene, bool single) {
                const oit::Frame frame = knots_frame(scene, {.samples = samples});
                oit::Renderer renderer(device(), frame, method);
                renderer.draw();
                oit::Reference reference = oit::draw_reference(frame);
                std::vector<cl_float4> image = renderer.image();
                for (std::size_t p = 0; single && p < image.size(); ++p)
                    if (reference.offsets[p + 1] - reference.offsets[p] > 1)
                        for (int c = 0; c < 3; ++c)
                            image[p].s[c] = static_cast<cl_float>(reference.image[p][c]);
                return oit::compare(reference, image, {}).psnr_db;
            };
            CHECK(psnr(many, true) > 80);
            CHECK(psnr(many, false) > 22);
        }
    }
}

// The mean of layers of one colour is that colour, whatever their weights are.
TEST_CASE("a hundred layers of one bright colour are as bright as each of them") {
    for (const float brightness : {1.0F, 1e6F, 1e7F}) {
        oit::Scene scene = oit::find_scene("extreme-underflow")->make(0);
        for (oit::Material& material : scene.materials)
            for (cl_float& channel : material.front_tint) channel = brightness;
        const oit::Frame frame{.scene = scene,
                               .views = {support::frame_unit_sphere({0, 0}, 40, 30)}};
        const oit::Reference reference = oit::draw_reference(frame);
        REQUIRE(reference.most_layers() == 100);
        for (const oit::MethodInfo& method : oit::methods()) {
            if (is_refused(method, frame)) continue;
            INFO(method.name << ", colours of " << brightness);
            oit::Renderer renderer(device(), frame, method);
            renderer.draw();
            const std::vector<cl_float4> image = renderer.image();
            double largest = 0;
            for (std::size_t p = 0; p < image.size(); ++p)
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, std::abs(static_cast<double>(image[p].s[c]) -
                                                         reference.image[p][c]));
            CHECK(largest < 1e-4 * static_cast<double>(renderer.features().colour_max));
        }
    }
}

TEST_CASE("blending that ends early is within its bound") {
    const oit::Scene scene = nested_knots(Blend::over);
    const oit::Reference reference = oit::draw_reference(knots_frame(scene));
    for (const float epsilon : {0.5F, 0.1F, 0.01F}) {
        const oit::Frame frame = knots_frame(scene, {.epsilon = epsilon});
        oit::Renderer renderer(device(), frame);
        renderer.draw();
        const std::vector<cl_float4> image = renderer.image();
        std::size_t wrong = 0, different = 0;
        for (std::size_t p = 0; p < image.size(); ++p)
            for (int c = 0; c < 3; ++c) {
                const double error =
                    std::abs(static_cast<double>(image[p].s[c]) - reference.image[p][c]);
                if (error > 1e-5) ++different;
                if (!reference.ambiguous[p] &&
                    error > static_cast<double>(epsilon * renderer.features().colour_max) + 1e-5)
                    ++wrong;
            }
        INFO("epsilon " << epsilon);
        CHECK(wrong == 0);
        if (epsilon > 0.05F) CHECK(different > 100);
    }
}

}  // namespace
}  // namespace cellist::test
