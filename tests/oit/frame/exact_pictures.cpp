// SPDX-License-Identifier: MIT
// Pictures with exact coverage: near to pictures of many samples, and the same bits however they
// are drawn.
#include <algorithm>
#include <cstring>
#include <random>

#include "camera.hpp"
#include "frame/views.hpp"
#include "input_error.hpp"
#include "methods/view_mean.hpp"
#include "oit/support/flat_scene.hpp"
#include "oit/support/procedural.hpp"
#include "oit/support/random_scene.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

oit::Frame frame_by_area(const oit::Scene& scene) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({30, 10}, 80, 60)},
            .quality = {.coverage = oit::Coverage::exact}};
}

bool same_bits(const std::vector<cl_float4>& a, const std::vector<cl_float4>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

// Surfaces that blend over each other and opaque ones; with filters, light has colours.
oit::Scene mixed_scene(bool with_filters) {
    std::vector<oit::Blend> blends{oit::Blend::over, oit::Blend::opaque, oit::Blend::additive};
    if (with_filters) blends.push_back(oit::Blend::multiplicative);
    return random_scene(with_filters ? 7 : 8, blends);
}

TEST_CASE("exact coverage is nearer to many samples than eight samples") {
    constexpr std::size_t across = 16;
    const oit::Scene knot = oit::scene_of(torus_knot(2, 3, 300, 16), 0.35F);
    const oit::Scene opaque = oit::scene_of(torus_knot(3, 5, 300, 16), 1);
    struct Case {
        const oit::Scene& scene;
        double least_gain_db;
    };
    const oit::Scene mixed = mixed_scene(true);
    for (const auto& [scene, least_gain_db] : {Case{knot, 6}, Case{opaque, 6}, Case{mixed, 3}}) {
        oit::Frame frame = frame_by_area(scene);
        oit::ViewMean mean(device(), frame);
        mean.draw(0, across * across, [&](std::size_t i) {
            const auto offset = [](std::size_t n) {
                return (static_cast<double>(n) + 0.5) / across - 0.5;
            };
            return std::vector<raster::View>{
                oit::moved_by(frame.views[0], {offset(i % across), offset(i / across)})};
        });
        const oit::Reference reference = mean.reference();
        const double of_areas = oit::compare(reference, drawn(frame), {}).psnr_db;
        frame.quality = {.samples = 8};
        const double by_samples = oit::compare(reference, drawn(frame), {}).psnr_db;
        INFO(of_areas << " dB, with 8 samples " << by_samples << " dB");
        CHECK(of_areas >= by_samples + least_gain_db);
    }
}

TEST_CASE("all lists and slices of memory give the same bits of exact coverage") {
    for (const bool with_filters : {false, true}) {
        const oit::Scene scene = mixed_scene(with_filters);
        oit::Frame frame = frame_by_area(scene);
        const std::vector<cl_float4> linked = drawn(frame);
        for (const char* method : {"counted", "fixed"})
            CHECK(same_bits(linked, drawn(frame, oit::method_named(method))));
        // The second frame goes into a pool that is known to be large enough.
        oit::Renderer renderer(device(), frame);
        renderer.warm_up();
        CHECK(same_bits(linked, renderer.image()));
        frame.memory_bytes = 200'000;
        oit::Renderer sliced(device(), frame);
        sliced.draw();
        CHECK(sliced.method().slices() > 1);
        CHECK(same_bits(linked, sliced.image()));
    }
}

TEST_CASE("two eyes are two pictures of exact coverage") {
    const oit::Scene scene = mixed_scene(false);
    oit::Frame frame = frame_by_area(scene);
    const std::vector<raster::View> views = support::frame_unit_sphere({30, 10}, 90, 70, 0.25);
    frame.views = views;
    const std::vector<cl_float4> both = drawn(frame);
    std::vector<cl_float4> one_by_one;
    for (const raster::View& view : views) {
        frame.views = {view};
        const std::vector<cl_float4> alone = drawn(frame);
        one_by_one.insert(one_by_one.end(), alone.begin(), alone.end());
    }
    CHECK(same_bits(both, one_by_one));
}

TEST_CASE("the order of the triangles does not matter to exact coverage") {
    std::mt19937 random(5);
    oit::Scene scene = mixed_scene(false);
    const std::vector<cl_float4> forwards = drawn(frame_by_area(scene));
    for (oit::Model& model : scene.models)
        std::shuffle(model.mesh.triangles.begin(), model.mesh.triangles.end(), random);
    CHECK(same_bits(forwards, drawn(frame_by_area(scene))));
}

TEST_CASE("media and functions are not drawn with exact coverage") {
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 60, 8), 0.35F);
    for (const oit::Blend blend : {oit::Blend::absorb, oit::Blend::user}) {
        scene.materials.front().blend = static_cast<cl_uint>(blend);
        oit::Frame frame = frame_by_area(scene);
        if (blend == oit::Blend::user)
            frame.blend_function = {
                "void blend(const OitFragment* fragment, float distance, "
                "float3* colour, float3* transmittance) {}",
                "nothing.cl"};
        const auto error =
            error_of<support::InputError>([&] { (void)oit::Renderer(device(), frame); });
        CHECK(contains(error.what(), "--samples 8"));
    }
}

}  // namespace
}  // namespace cellist::test
