// SPDX-License-Identifier: MIT
// The computed scenes are what they are said to be.
#include "scene/scenes.hpp"

#include <cmath>
#include <set>

#include <glm/geometric.hpp>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

oit::Scene scene_named(const std::string& name) {
    const oit::SceneInfo* info = oit::find_scene(name);
    REQUIRE(info != nullptr);
    return info->make(0.35F);
}

// Draws the scene and requires that no pixel differs from the reference by more than 1/255, unless
// float cannot tell depths apart, which is so in a part `most_over` of the pixels at most. Returns
// the length of the longest list.
std::uint64_t require_accurate(const oit::Scene& scene, int width, int height,
                               const support::Orbit& orbit = {60, 25}, double most_over = 1e-4) {
    const oit::Frame frame{.scene = scene,
                           .views = {support::frame_unit_sphere(orbit, width, height)}};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const oit::Comparison comparison =
        oit::compare(oit::draw_reference(frame), renderer.image(), renderer.method().depths());
    INFO(comparison.pixels_over << " pixels are off by over 1/255, the largest error is "
                                << 255 * comparison.max_abs_error << "/255");
    CHECK(comparison.pixels_with_other_count == 0);
    CHECK(comparison.pixels_explained == comparison.pixels_over);
    CHECK(static_cast<double>(comparison.pixels_over) <=
          most_over * static_cast<double>(comparison.pixels));
    return renderer.method().lengths()->longest;
}

// Every scene that is drawn lies in the unit sphere, with normals on the side from which corners
// run counter-clockwise.
void require_sound(const oit::Scene& scene) {
    for (const oit::Instance& instance : scene.instances) {
        const support::Mesh& mesh = scene.models[instance.model].mesh;
        for (const double time : {0.0, 3.7})
            for (const glm::vec3& p : mesh.positions) {
                const glm::dvec4 q = transform_at(instance, time) * glm::dvec4(glm::dvec3(p), 1);
                REQUIRE(glm::length(glm::dvec3(q)) <= 1.0001);
            }
        for (const auto& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]),
                c(mesh.positions[t[2]]);
            const glm::dvec3 normal(mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]]);
            REQUIRE(glm::dot(glm::cross(b - a, c - a), normal) > 0);
        }
    }
}

TEST_CASE("gearworks has 602,000 triangles, 254,000 of them transparent, and up to 64 layers") {
    const oit::Scene scene = scene_named("gearworks");
    require_sound(scene);
    std::uint64_t transparent = 0;
    for (const oit::Instance& instance : scene.instances)
        if (!scene.is_opaque(instance))
            transparent += scene.models[instance.model].mesh.triangles.size();
    CHECK(scene.triangles() == 602'000);
    CHECK(transparent == 254'000);
    CHECK(require_accurate(scene, 640, 360) > 40);
    oit::Frame frame{
        .scene = scene, .views = {support::frame_unit_sphere({50, -45}, 1280, 720)}, .time = 0.9};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    CHECK(renderer.method().lengths()->longest == 64);
}

TEST_CASE("gearworks moves, and the reference with it") {
    const oit::Scene scene = scene_named("gearworks");
    oit::Frame frame{.scene = scene, .views = {support::frame_unit_sphere({25, 8}, 160, 90)}};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const std::vector<cl_float4> before = renderer.image();
    frame.time = 1.5;
    renderer.draw_changed();
    const std::vector<cl_float4> after = renderer.image();
    const oit::Reference reference = oit::draw_reference(frame);
    CHECK(oit::compare(reference, after, {}).pixels_over == 0);
    CHECK(oit::compare(reference, before, {}).pixels_over > 100);
}

TEST_CASE("blends has surfaces of all kinds, in front of one another") {
    const oit::Scene scene = scene_named("blends");
    require_sound(scene);
    std::set<cl_uint> kinds;
    for (const oit::Instance& instance : scene.instances)
        kinds.insert(scene.material_of(instance).blend);
    for (const oit::Blend blend : {oit::Blend::opaque, oit::Blend::over, oit::Blend::additive,
                                   oit::Blend::multiplicative, oit::Blend::absorb})
        CHECK(kinds.contains(static_cast<cl_uint>(blend)));
    CHECK(require_accurate(scene, 640, 360) > 12);
}

TEST_CASE("smoke has layers of every opacity") {
    const oit::Scene scene = scene_named("smoke");
    for (const oit::Model& model : scene.models)
        for (const float opacity : model.opacities) REQUIRE((opacity >= 0 && opacity <= 1));
    CHECK(require_accurate(scene, 320, 180) > 8);
}

TEST_CASE("scenes at the limits of numbers are drawn as accurately as others") {
    for (const oit::SceneInfo& info : oit::scenes()) {
        if (!info.name.starts_with("extreme-")) continue;
        INFO(info.name);
        // Surfaces in one plane have an order that float does not know, all over.
        const double most_over = info.name == "extreme-coplanar" ? 1 : 1e-4;
        for (const support::Orbit& orbit : {support::Orbit{0, 0}, {-130, 35}})
            require_accurate(info.make(0.35F), 96, 80, orbit, most_over);
    }
}

TEST_CASE("ten thousand layers are blended") {
    CHECK(require_accurate(scene_named("extreme-layers"), 64, 64, {0, 0}) == 10'000);
}

}  // namespace
}  // namespace cellist::test
