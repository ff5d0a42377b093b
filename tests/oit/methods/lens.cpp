// SPDX-License-Identifier: MIT
// Pictures through a lens match formulas, and means of pinhole pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>

#include "camera.hpp"
#include "input_error.hpp"
#include "methods/renderer.hpp"
#include "methods/view_mean.hpp"
#include "oit/support/procedural.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using oit::Blend;
using oit::Lens;

// A small knot in a large one, on a floor.
oit::Scene knots(Blend outer, float inner_alpha = 1) {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 200, 12), 0.3F);
    scene.materials.front().blend = static_cast<cl_uint>(outer);
    oit::Material inner = oit::glass(inner_alpha);
    if (inner_alpha == 1) inner.blend = static_cast<cl_uint>(Blend::opaque);
    scene.instances.push_back({.material = scene.materials.size(),
                               .to_world = glm::scale(glm::dmat4(1), glm::dvec3(0.6))});
    scene.materials.push_back(inner);
    oit::add_floor(scene);
    return scene;
}

oit::Frame lens_frame(const oit::Scene& scene, const Lens& lens, const oit::Quality& quality = {}) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 96, 72)},
            .quality = quality,
            .lens = lens};
}

std::vector<cl_float4> draw(const oit::Frame& frame, const std::string& method = "linked") {
    oit::Renderer renderer(device(), frame, oit::method_named(method));
    renderer.draw();
    const std::vector<cl_float4> image = renderer.image();
    CHECK(image.size() == frame.pixels());
    CHECK(oit::count_nan(image) == 0);
    return image;
}

// The mean of pinhole pictures: another way to the picture, with the same rasteriser.
oit::Reference mean_of_views(const oit::Frame& frame) {
    constexpr std::size_t views = 200;
    oit::ViewMean mean(device(), frame);
    mean.draw(frame.time, views, oit::views_through_lens(frame, views));
    return mean.reference();
}

double psnr(const oit::Reference& reference, const std::vector<cl_float4>& image) {
    return oit::compare(reference, image, {}).psnr_db;
}

double greatest_difference(const std::vector<cl_float4>& a, const std::vector<cl_float4>& b) {
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c)
            most = std::max(most, static_cast<double>(std::abs(a[i].s[c] - b[i].s[c])));
    return most;
}

// ---- sheets whose blur has a formula ------------------------------------------------------------

constexpr double focal_pixels = 40;

// Shows (x, y, z) at x / z and y / z times the focal length from the middle.
raster::View sheet_view() {
    raster::View view{};
    view.row_x[0] = view.row_y[1] = static_cast<cl_float>(focal_pixels * RASTER_SUBPIXELS);
    view.row_w[2] = 1;
    view.ray_x[0] = view.ray_y[1] = static_cast<cl_float>(1 / focal_pixels);
    view.width = 64;
    view.height = 48;
    view.ray_origin[0] = static_cast<cl_float>(-0.5 * (view.width - 1) / focal_pixels);
    view.ray_origin[1] = static_cast<cl_float>(-0.5 * (view.height - 1) / focal_pixels);
    view.ray_origin[2] = 1;
    view.near_depth = 0.1F;
    return view;
}

// Adds an opaque sheet of one colour at a depth. It spans the columns `from` to `to`, counted from
// the middle.
void add_sheet(oit::Scene& scene, double depth, double from, double to, float colour) {
    support::Mesh mesh;
    const auto at = [&](double pixels) {
        return static_cast<float>(pixels * depth / focal_pixels);
    };
    for (const auto& [x, y] : {std::pair(from, -100.0), std::pair(to, -100.0), std::pair(to, 100.0),
                               std::pair(from, 100.0)}) {
        mesh.positions.emplace_back(at(x), at(y), static_cast<float>(depth));
        mesh.normals.emplace_back(0.0F, 0.0F, -1.0F);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    oit::Material material = oit::glass(1);
    material.blend = static_cast<cl_uint>(Blend::opaque);
    material.gloss = 0;
    for (int c = 0; c < 3; ++c) material.front_tint[c] = material.back_tint[c] = colour;
    scene.instances.push_back({.model = scene.models.size(), .material = scene.materials.size()});
    scene.models.push_back({.mesh = mesh});
    scene.materials.push_back(material);
}

// The light leaves surfaces the colours of their tints.
oit::Scene sheets() {
    oit::Scene scene;
    oit::Lighting& light = scene.lighting;
    for (int c = 0; c < 3; ++c) {
        light.sky[c] = light.ground[c] = 1;
        light.key[c] = light.rim[c] = light.background_top[c] = light.background_bottom[c] = 0;
    }
    return scene;
}

// The part of a disc to the left of a line `right` radii to the right of its centre.
double part_of_disc(double right) {
    const double t = std::clamp(right, -1.0, 1.0);
    return 1 - (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi;
}

// Compares the middle row, and one near the top.
void require_columns(const oit::Frame& frame, const std::vector<cl_float4>& image,
                     const std::function<double(double)>& expected) {
    for (const int y : {5, 24})
        for (int x = 0; x < frame.width(); ++x) {
            const double from_middle = x + 0.5 - 0.5 * frame.width();
            INFO("column " << x << ", row " << y);
            CHECK(
                static_cast<double>(image[static_cast<std::size_t>(y * frame.width() + x)].s[0]) ==
                Approx(expected(from_middle)).margin(0.02));
        }
}

oit::Frame sheet_frame(const oit::Scene& scene, const Lens& lens) {
    return {.scene = scene, .views = {sheet_view()}, .quality = {.lens_rays = 1024}, .lens = lens};
}

}  // namespace

TEST_CASE("a lens of radius 0 draws the pinhole picture") {
    const oit::Scene scene = knots(Blend::over);
    oit::Frame frame = lens_frame(scene, {.radius = 0, .focus = 3});
    const std::vector<cl_float4> through_lens = draw(frame);
    frame.lens.reset();
    // A ray ends when its transmittance is at most 2^-10.
    CHECK(greatest_difference(through_lens, draw(frame)) < 2e-3);
}

TEST_CASE("an edge out of focus blurs as a disc that a line cuts") {
    // The sheet in front ends at the middle. The sheet behind it is in focus.
    oit::Scene scene = sheets();
    add_sheet(scene, 2, -100, 100, 0.8F);
    add_sheet(scene, 1, -100, 0, 0.2F);
    const oit::Frame frame = sheet_frame(scene, {.radius = 0.5, .focus = 2});
    const double circle = focal_pixels * 0.5 * 0.5;
    require_columns(frame, draw(frame),
                    [&](double x) { return 0.8 - 0.6 * part_of_disc(-x / circle); });
}

TEST_CASE("an edge in focus stays sharp in front of a blurred background") {
    oit::Scene scene = sheets();
    add_sheet(scene, 2, -100, 10, 0.8F);
    add_sheet(scene, 1, -100, 0, 0.2F);
    const oit::Frame frame = sheet_frame(scene, {.radius = 0.5, .focus = 1});
    const double circle = focal_pixels * 0.5 * 0.5;
    require_columns(frame, draw(frame),
                    [&](double x) { return x < 0 ? 0.2 : 0.8 * part_of_disc((10 - x) / circle); });
}

TEST_CASE("surfaces outside of the image blur into it") {
    oit::Scene scene = sheets();
    add_sheet(scene, 2, -100, 100, 0.8F);
    add_sheet(scene, 1, -100, -36, 0.2F);
    const oit::Frame frame = sheet_frame(scene, {.radius = 0.5, .focus = 2});
    const double circle = focal_pixels * 0.5 * 0.5;
    require_columns(frame, draw(frame),
                    [&](double x) { return 0.8 - 0.6 * part_of_disc((-36 - x) / circle); });
}

TEST_CASE("nothing in view leaves the background") {
    const oit::Scene scene = sheets();
    for (const std::string method : {"linked", "kbuffer", "blur", "peeled", "positions"})
        CHECK(greatest_difference(draw(sheet_frame(scene, {.radius = 1, .focus = 2}), method),
                                  std::vector<cl_float4>(64 * 48)) == 0);
}

// No bound is known for the edges of bodies, which are as coarse as pixels in these small pictures.
// The limits below are about 1 dB under what was measured.
TEST_CASE("pictures through a lens are near the mean of many views, however surfaces blend") {
    for (const Blend blend : {Blend::over, Blend::additive, Blend::multiplicative, Blend::absorb}) {
        INFO("blend " << static_cast<int>(blend));
        const oit::Scene scene = knots(blend, blend == Blend::over ? 1 : 0.4F);
        const oit::Frame frame =
            lens_frame(scene, {.radius = 0.15, .focus = 3.2}, {.lens_rays = 128});
        oit::Frame pinhole = frame;
        pinhole.lens.reset();
        const oit::Reference reference = mean_of_views(frame);
        const double through_lens = psnr(reference, draw(frame));
        const double without = psnr(reference, draw(pinhole));
        INFO(through_lens << " dB, and " << without << " dB without a lens");
        CHECK(through_lens > 32);
        CHECK(through_lens > without + 6);
    }
}

TEST_CASE("lenses of any aperture and focus give what many views give") {
    const oit::Scene scene = knots(Blend::over);
    for (const Lens& lens : {Lens{2, 3.5}, Lens{0.1, 1e-6}, Lens{0.01, -1e-6}, Lens{0.1, 0.5},
                             Lens{0.1, HUGE_VAL}, Lens{0.1, -5}, Lens{1e-4, 2.5}}) {
        INFO("radius " << lens.radius << ", focus " << lens.focus);
        const oit::Frame frame = lens_frame(scene, lens, {.lens_rays = 128});
        CHECK(psnr(mean_of_views(frame), draw(frame)) > 30);
    }
    draw(lens_frame(scene, {.radius = 100, .focus = 4}));
}

TEST_CASE("both eyes look through a lens") {
    const oit::Scene scene = knots(Blend::over);
    oit::Frame frame = lens_frame(scene, {.radius = 0.15, .focus = 3.2});
    frame.views = support::frame_unit_sphere({30, 10}, 96, 72, 0.2);
    CHECK(psnr(mean_of_views(frame), draw(frame)) > 31);
}

// A grating in front of a striped wall, both opaque.
TEST_CASE("layers show what one picture hides") {
    oit::Scene scene = sheets();
    for (int i = -100; i < 100; i += 8) add_sheet(scene, 2, i, i + 4, i % 16 == 0 ? 0.8F : 0.3F);
    for (int i = -100; i < 100; i += 20) add_sheet(scene, 1, i, i + 5, 0.05F);
    oit::Frame frame = sheet_frame(scene, {.radius = 0.3, .focus = 2});
    frame.quality = {};
    const oit::Reference reference = mean_of_views(frame);
    const auto quality_of = [&](const std::string& name, std::optional<std::uint32_t> size) {
        oit::Frame sized = frame;
        sized.quality.size = size;
        return psnr(reference, draw(sized, name));
    };
    const double all = psnr(reference, draw(frame));
    CHECK(all > 36);
    CHECK(all > quality_of("blur", {}) + 6);
    CHECK(all > quality_of("peeled", 1) + 6);
    CHECK(quality_of("peeled", 2) == Approx(all).margin(0.01));
    CHECK(quality_of("kbuffer", 2) == Approx(all).margin(0.01));
    CHECK(quality_of("positions", 64) > all - 6);
}

TEST_CASE("the storage of the fragments does not matter, nor when they are stored") {
    const oit::Scene scene = knots(Blend::over);
    const oit::Frame frame = lens_frame(scene, {.radius = 0.15, .focus = 3.2});
    const std::vector<cl_float4> first = draw(frame);
    for (const std::string method : {"linked", "counted", "fixed"}) {
        oit::Renderer renderer(device(), frame, oit::method_named(method));
        for (int run = 0; run < 5; ++run) {
            renderer.draw();
            const std::vector<cl_float4> image = renderer.image();
            INFO(method);
            CHECK(std::memcmp(image.data(), first.data(), first.size() * sizeof(cl_float4)) == 0);
        }
    }
}

TEST_CASE("a frame follows its view and time through a lens") {
    const oit::Scene scene = knots(Blend::over);
    oit::Frame frame = lens_frame(scene, {.radius = 0.15, .focus = 3.2});
    oit::Renderer renderer(device(), frame, oit::method_named("linked"));
    renderer.draw();
    frame.views = {support::frame_unit_sphere({100, -20}, 96, 72)};
    renderer.draw_changed();
    CHECK(greatest_difference(renderer.image(), draw(frame)) < 1e-6);
}

TEST_CASE("methods for lenses refuse pinholes") {
    const oit::Scene scene = knots(Blend::over);
    oit::Frame frame = lens_frame(scene, {});
    frame.lens.reset();
    for (const std::string method : {"blur", "peeled", "positions"}) {
        const auto error = error_of<support::InputError>(
            [&] { (void)oit::Renderer(device(), frame, oit::method_named(method)); });
        CHECK(contains(error.what(), "add --lens"));
    }
}

}  // namespace cellist::test
