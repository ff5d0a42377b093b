// SPDX-License-Identifier: MIT
// Frames agree with the reference in double precision.
#include <filesystem>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/procedural.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

struct MeshView {
    support::Orbit orbit;
    int width, height;
    float alpha = 0.35F;
    std::optional<std::uint32_t> layers = {};
    bool floor = false;
};

void require_accurate(const support::Mesh& mesh, const MeshView& c) {
    INFO("view " << c.orbit.azimuth_degrees << "," << c.orbit.elevation_degrees << ", " << c.width
                 << "x" << c.height << ", alpha " << c.alpha << ", layers "
                 << (c.layers ? std::to_string(*c.layers) : "all") << ", floor " << c.floor);
    oit::Scene scene = oit::scene_of(mesh, c.alpha);
    if (c.floor) oit::add_floor(scene);
    const oit::Frame frame{.scene = scene,
                           .views = {support::frame_unit_sphere(c.orbit, c.width, c.height)},
                           .quality = {.layers = c.layers}};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    const oit::Comparison comparison =
        oit::compare(oit::draw_reference(frame), renderer.image(), renderer.method().depths());
    CHECK(comparison.fragments > 0);
    CHECK(comparison.pixels_with_other_count == 0);
    CHECK(comparison.max_depth_error <= oit::depth_resolution / 2);
    CHECK(comparison.max_abs_error <= 8.0 / 255);
    CHECK(static_cast<double>(comparison.pixels_over) <=
          1e-4 * static_cast<double>(comparison.pixels));
    CHECK(comparison.pixels_explained == comparison.pixels_over);
}

TEST_CASE("a knot of many layers is drawn as accurately as promised") {
    const support::Mesh knot = torus_knot(3, 7, 900, 24);
    for (const support::Orbit& orbit : {support::Orbit{25, 8}, {140, 35}, {-70, -20}})
        for (const bool floor : {false, true})
            require_accurate(knot, {.orbit = orbit, .width = 400, .height = 300, .floor = floor});
}

TEST_CASE("the nearest layers are the nearest") {
    const support::Mesh knot = torus_knot(3, 7, 600, 16);
    for (const std::uint32_t layers : {1u, 2u, 7u, 16u, 17u, 1000u, 4294967295u})
        require_accurate(knot, {.orbit = {0, 2}, .width = 200, .height = 150, .layers = layers});
}

TEST_CASE("every opacity from nothing to opaque is accurate") {
    const support::Mesh knot = torus_knot(2, 3, 300, 16);
    for (const float alpha : {0.0F, 0x1p-24F, 0.01F, 0.5F, 1 - 0x1p-24F, 1.0F})
        require_accurate(knot, {.orbit = {10, 20}, .width = 160, .height = 120, .alpha = alpha});
}

TEST_CASE("every direction and shape of image is accurate") {
    const support::Mesh knot = torus_knot(2, 5, 300, 12);
    for (const support::Orbit& orbit :
         {support::Orbit{0, 90}, {0, -90}, {90, 0}, {180, 45}, {-359, 0}})
        require_accurate(knot, {.orbit = orbit, .width = 61, .height = 203, .floor = true});
}

TEST_CASE("large triangles are as accurate as small ones") {
    // A few dozen triangles, each far larger than a tile.
    const support::Mesh knot = torus_knot(2, 3, 9, 4);
    for (const bool floor : {false, true})
        require_accurate(knot, {.orbit = {30, 20}, .width = 640, .height = 480, .floor = floor});
}

TEST_CASE("the bunny is drawn as accurately as promised") {
    const std::filesystem::path path = CELLIST_BUNNY_PATH;
    if (!std::filesystem::exists(path))
        CELLIST_SKIP("there is no " + path.string() + ": install glmark2-data");
    support::Mesh bunny = support::load_mesh(path);
    support::fit_to_unit_sphere(bunny);
    require_accurate(bunny, {.orbit = {25, 8}, .width = 1280, .height = 720});
    require_accurate(bunny,
                     {.orbit = {-70, 30}, .width = 512, .height = 512, .layers = 2, .floor = true});
}

}  // namespace
}  // namespace cellist::test
