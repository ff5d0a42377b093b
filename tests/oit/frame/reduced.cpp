// SPDX-License-Identifier: MIT
// Transparent surfaces at reduced resolution keep the edges of the opaque ones sharp.
#include <cmath>

#include <glm/ext/matrix_transform.hpp>

#include "camera.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

// A sheet of glass larger than the screen.
support::Mesh sheet() {
    support::Mesh mesh;
    for (const glm::vec2& corner : {glm::vec2(-9, -9), {9, -9}, {9, 9}, {-9, 9}}) {
        mesh.positions.emplace_back(corner, 0.0F);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

// An opaque knot between sheets, one in front of it and two behind: no transparent surface ends
// within the picture, or where it meets an opaque one.
oit::Scene knot_between_sheets(oit::Blend blend) {
    oit::Scene scene;
    scene.models = {{.mesh = torus_knot(2, 3, 200, 12)}, {.mesh = sheet()}};
    scene.materials = {oit::glass(1), oit::glass(0.4F), oit::glass(0.3F)};
    scene.materials[0].blend = static_cast<cl_uint>(oit::Blend::opaque);
    scene.materials[1].blend = static_cast<cl_uint>(blend);
    scene.instances = {{.model = 0, .material = 0}};
    const auto add = [&](double z, std::size_t material) {
        scene.instances.push_back({.model = 1,
                                   .material = material,
                                   .to_world = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, z))});
    };
    add(1.1, 1);
    add(-1.1, 2);
    add(-1.2, 1);
    return scene;
}

oit::Frame reduced_frame(const oit::Scene& scene, int reduce,
                         const support::Orbit& orbit = {0, 0}) {
    // Sides that are no multiples of 4.
    return {.scene = scene,
            .views = {support::frame_unit_sphere(orbit, 207, 150)},
            .quality = {.reduce = reduce}};
}

std::vector<cl_float4> draw_twice(const oit::Frame& frame, const oit::MethodInfo& method) {
    oit::Renderer renderer(device(), frame, method);
    renderer.draw();
    renderer.draw();
    return renderer.image();
}

std::vector<cl_float4> draw_twice(const oit::Frame& frame) {
    return draw_twice(frame, oit::method_named("linked"));
}

TEST_CASE("edges of opaque surfaces stay sharp behind and in front of smooth ones") {
    for (const auto& [blend, reduce] :
         {std::pair{oit::Blend::over, 2}, {oit::Blend::multiplicative, 4}}) {
        const oit::Scene scene = knot_between_sheets(blend);
        const oit::Frame frame = reduced_frame(scene, reduce);
        const oit::Comparison comparison =
            oit::compare(oit::draw_reference(frame), draw_twice(frame), {});
        INFO("reduced by " << reduce << ": " << 255 * comparison.max_abs_error << " / 255");
        CHECK(comparison.max_abs_error < 1.5 / 255);
        CHECK(comparison.pixels_nan == 0);
    }
}

// Whether what a pixel shows of the transparent surfaces changes between it and those around it.
bool is_even(const oit::Reference& reference, int width, int height, int x, int y, int reach) {
    const auto layers = [&](int u, int v) {
        const auto p = static_cast<std::size_t>(v * width + u);
        return reference.offsets[p + 1] - reference.offsets[p];
    };
    for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
            if (layers(u, v) != layers(x, y)) return false;
    return true;
}

TEST_CASE("surfaces are as they were but near their edges") {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 300, 24), 0.35F);
    oit::add_floor(scene);
    for (const int reduce : {2, 4}) {
        const oit::Frame frame{.scene = scene,
                               .views = {support::frame_unit_sphere({25, 8}, 400, 300)},
                               .quality = {.reduce = reduce}};
        const std::vector<cl_float4> image = draw_twice(frame);
        const oit::Reference reference = oit::draw_reference(frame);
        double squares = 0;
        std::size_t count = 0;
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 400; ++x) {
                const auto p = static_cast<std::size_t>(400 * y + x);
                if (reference.offsets[p + 1] == reference.offsets[p] ||
                    !is_even(reference, 400, 300, x, y, 2 * reduce))
                    continue;
                ++count;
                for (int c = 0; c < 3; ++c)
                    squares +=
                        std::pow(support::srgb_from_linear(static_cast<double>(image[p].s[c])) -
                                     support::srgb_from_linear(reference.image[p][c]),
                                 2);
            }
        INFO("reduced by " << reduce << ", " << count << " pixels");
        CHECK(count > 1000);
        CHECK(-10 * std::log10(squares / (3.0 * static_cast<double>(count))) > 36);
    }
}

TEST_CASE("every method can draw at reduced resolution") {
    const oit::Scene scene = knot_between_sheets(oit::Blend::over);
    const oit::Frame frame = reduced_frame(scene, 2);
    const oit::Reference reference = oit::draw_reference(frame);
    for (const oit::MethodInfo& method : oit::methods()) {
        if (!method.refusal(frame, features_of(frame)).empty()) continue;
        const std::vector<cl_float4> image = draw_twice(frame, method);
        const oit::Comparison comparison = oit::compare(reference, image, {});
        INFO(method.name << ": " << comparison.psnr_db << " dB");
        CHECK(comparison.pixels_nan == 0);
        CHECK(comparison.psnr_db > (method.exact ? 60 : 22));
    }
}

TEST_CASE("each eye is enlarged by its own depths") {
    const oit::Scene scene = knot_between_sheets(oit::Blend::over);
    oit::Frame frame = reduced_frame(scene, 4);
    frame.views = support::frame_unit_sphere({0, 0}, 207, 150, 0.2);
    const oit::Comparison comparison =
        oit::compare(oit::draw_reference(frame), draw_twice(frame), {});
    INFO(255 * comparison.max_abs_error << " / 255");
    CHECK(comparison.max_abs_error < 1.5 / 255);
}

TEST_CASE("reduced surfaces need fewer nodes, and none at all where there are none") {
    oit::Scene scene = knot_between_sheets(oit::Blend::over);
    const oit::Frame frame = reduced_frame(scene, 4), full = reduced_frame(scene, 1);
    oit::Renderer reduced(device(), frame), whole(device(), full);
    reduced.draw();
    whole.draw();
    CHECK(12 * reduced.method().lengths()->total < whole.method().lengths()->total);

    scene.instances.resize(1);  // the knot alone
    CHECK(oit::compare(oit::draw_reference(frame), draw_twice(frame), {}).pixels_over == 0);
    scene.instances.clear();
    CHECK(oit::compare(oit::draw_reference(frame), draw_twice(frame), {}).pixels_over == 0);
}

TEST_CASE("reduced surfaces with several samples are refused") {
    const oit::Scene scene = knot_between_sheets(oit::Blend::over);
    oit::Frame frame = reduced_frame(scene, 2);
    frame.quality.samples = 4;
    const std::string message =
        error_of<support::InputError>([&] { oit::Renderer(device(), frame); }).what();
    CHECK(contains(message, "one sample"));
}

}  // namespace
}  // namespace cellist::test
