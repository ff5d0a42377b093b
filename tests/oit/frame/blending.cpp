// SPDX-License-Identifier: MIT
// Every way of blending agrees with the reference, alone and mixed with others.
#include <array>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "camera.hpp"
#include "input_error.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using oit::Blend;

// Knots, one inside of the other, each with a way of blending.
oit::Scene turned_knots(const std::vector<Blend>& blends) {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 240, 16), 0.4F);
    scene.instances.clear();
    scene.materials.clear();
    for (std::size_t i = 0; i < blends.size(); ++i) {
        oit::Material material = oit::glass(0.2F + 0.1F * static_cast<float>(i));
        material.blend = static_cast<cl_uint>(blends[i]);
        scene.materials.push_back(material);
        const glm::dmat4 turned =
            glm::rotate(glm::dmat4(1), 0.5 * static_cast<double>(i), glm::dvec3(0.3, 1, 0.2));
        scene.instances.push_back(
            {.material = i,
             .to_world = glm::scale(turned, glm::dvec3(1 - 0.2 * static_cast<double>(i)))});
    }
    return scene;
}

void require_accurate(const oit::Frame& frame, const oit::ReferenceOptions& options = {}) {
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const oit::Comparison comparison = oit::compare(oit::draw_reference(frame, options),
                                                    renderer.image(), renderer.method().depths());
    INFO(255 * comparison.max_abs_error << "/255");
    CHECK(comparison.fragments > 1000);
    CHECK(comparison.pixels_with_other_count == 0);
    CHECK(comparison.pixels_over == comparison.pixels_explained);
    CHECK(static_cast<double>(comparison.pixels_over) <=
          1e-4 * static_cast<double>(comparison.pixels));
}

TEST_CASE("surfaces cover, add, tint and absorb as in double precision") {
    for (const std::vector<Blend>& blends :
         {std::vector<Blend>{Blend::over},
          {Blend::additive},
          {Blend::multiplicative},
          {Blend::absorb},
          {Blend::over, Blend::additive, Blend::multiplicative, Blend::absorb}}) {
        INFO(blends.size() << " kinds, the first is " << static_cast<int>(blends.front()));
        oit::Scene scene = turned_knots(blends);
        for (const bool floor : {false, true}) {
            if (floor) oit::add_floor(scene);
            require_accurate(
                {.scene = scene, .views = {support::frame_unit_sphere({20, 15}, 200, 150)}});
        }
    }
}

TEST_CASE("a medium without a glossy surface absorbs alone") {
    oit::Scene scene = turned_knots({Blend::absorb});
    scene.materials.front().gloss = 0;
    require_accurate({.scene = scene, .views = {support::frame_unit_sphere({20, 15}, 200, 150)}});
}

// Slabs of a medium that is not glossy, each between two values of z. The two faces of a slab are
// split along different diagonals, so float rounds their depths differently.
oit::Scene slabs_of(const std::vector<std::pair<float, float>>& ranges) {
    oit::Scene scene;
    support::Mesh mesh;
    for (const auto& [front, back] : ranges) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const float z : {front, back})
            for (const float y : {-1.0F, 1.0F})
                for (const float x : {-1.0F, 1.0F}) {
                    mesh.positions.emplace_back(x, y, z);
                    mesh.normals.emplace_back(0.0F, 0.0F, z == front ? 1.0F : -1.0F);
                }
        for (const auto& [a, b, c] :
             {std::array{0U, 1U, 3U}, {0U, 3U, 2U}, {4U, 6U, 5U}, {5U, 6U, 7U}})
            mesh.triangles.push_back({first + a, first + b, first + c});
    }
    scene.models.push_back({.mesh = mesh});
    oit::Material medium = oit::glass(1);
    medium.blend = static_cast<cl_uint>(Blend::absorb);
    medium.gloss = 0;
    for (int i = 0; i < 3; ++i)
        medium.front_tint[i] = medium.back_tint[i] = 0.1F + 0.4F * static_cast<float>(i);
    scene.materials.push_back(medium);
    scene.instances.push_back({});
    for (int i = 0; i < 3; ++i)
        scene.lighting.background_top[i] = scene.lighting.background_bottom[i] = 0.8F;
    // At opacity 0, what adds to an absorbing surface is nothing.
    for (int i = 0; i < 3; ++i) scene.lighting.rim[i] = 0;
    return scene;
}

TEST_CASE("light passes a slab by the law of Beer and Lambert") {
    // Seen straight on, in front of the background.
    const oit::Scene scene = slabs_of({{0.25F, -0.25F}});
    const oit::Frame frame{.scene = scene, .views = {support::frame_unit_sphere({0, 0}, 33, 33)}};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const cl_float4 middle = renderer.image()[16 * 33 + 16];
    for (int i = 0; i < 3; ++i) {
        const double passes = std::pow(0.1 + 0.4 * i, 0.5);
        CHECK(std::abs(static_cast<double>(middle.s[i]) - 0.8 * passes) < 1e-5);
    }
}

TEST_CASE("a slab thinner than float resolves does not change what is behind it") {
    const oit::Scene scene = slabs_of({{0.5F, 0.49999997F}, {-0.4F, -0.6F}});
    require_accurate({.scene = scene, .views = {support::frame_unit_sphere({20, 15}, 200, 150)}});
}

// ---- the user's function ---------------------------------------------------------------------

oit::Frame user_frame(const oit::Scene& scene, const std::string& body) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({20, 15}, 160, 120)},
            .blend_function = oit::BlendFunction{
                "static void blend(const OitFragment* fragment, float distance, float3* colour,\n"
                "                  float3* transmittance) {\n" +
                    body + "\n}\n",
                "mine.cl"}};
}

TEST_CASE("a function of the user's blends") {
    const oit::Scene scene = turned_knots({Blend::user, Blend::over, Blend::user});
    const oit::Frame frame = user_frame(scene, R"(
    const float part = fragment->alpha * exp(-2.0f * distance);
    *colour += *transmittance * part * fragment->colour;
    *transmittance *= (1.0f - part) * (float3)(1.0f, 0.9f, 0.8f);)");
    require_accurate(frame, {.blend = [](const oit::ReferenceFragment& fragment, double distance,
                                         glm::dvec3& colour, glm::dvec3& transmittance) {
                         const double part = fragment.alpha * std::exp(-2 * distance);
                         colour += transmittance * part * fragment.colour;
                         transmittance *= (1 - part) * glm::dvec3(1, 0.9F, 0.8F);
                     }});
}

TEST_CASE("a function that does not compile is refused with the file and the line") {
    const oit::Scene scene = turned_knots({Blend::user});
    const oit::Frame frame = user_frame(scene, "    *colour = 1.0f;\n    no_such_thing();");
    const auto error = error_of<support::InputError>([&] { oit::Renderer(device(), frame); });
    INFO(error.what());
    CHECK(contains(error.what(), "mine.cl"));
    CHECK(contains(error.what(), "no_such_thing"));
    CHECK(contains(error.what(), ":4"));
}

TEST_CASE("pixels for which a function gives no number are counted") {
    const oit::Scene scene = turned_knots({Blend::user});
    const oit::Frame frame = user_frame(scene, "    *colour = NAN;");
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    CHECK(oit::count_nan(renderer.image()) == renderer.method().lengths()->nonempty_cells);
}

}  // namespace
}  // namespace cellist::test
