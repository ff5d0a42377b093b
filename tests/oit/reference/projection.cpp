// SPDX-License-Identifier: MIT
// The reference projects and clips with code of its own: it agrees with real numbers, and the
// rasteriser agrees with it where the near plane and the guard band cut triangles.
#include "reference/projection.hpp"

#include <algorithm>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

// Triangles around the eye, many of which pass beside it and behind it.
support::Mesh triangles_around(std::mt19937& random, int count) {
    std::uniform_real_distribution<float> coordinate(-6, 6);
    support::Mesh mesh;
    for (int t = 0; t < count; ++t) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int corner = 0; corner < 3; ++corner) {
            mesh.positions.emplace_back(coordinate(random), coordinate(random), coordinate(random));
            mesh.normals.emplace_back(0.0F, 1.0F, 0.0F);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST_CASE("positions are those of real numbers, up to a sub-pixel near the image") {
    CELLIST_RANDOM(random, 401u);
    const raster::View view = support::frame_unit_sphere({25, 15}, 1280, 720);
    const oit::Projection<float> rounded(glm::dmat4(1), view);
    const oit::Projection<double> real(glm::dmat4(1), view);
    const support::Mesh mesh = triangles_around(random, 20'000);
    int compared = 0, clipped = 0, off = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::array corners{mesh.positions[a], mesh.positions[b], mesh.positions[c]};
        const auto is = rounded.clipped(corners);
        const auto should = real.clipped(corners);
        if (is.size() != should.size()) {
            ++off;
            continue;
        }
        if (is.size() > 3) ++clipped;
        for (std::size_t i = 0; i < is.size(); ++i) {
            const auto [x, y] = rounded.position(is[i]);
            const auto [real_x, real_y] = real.position(should[i]);
            if (std::hypot(real_x, real_y) > 2 * view.width * RASTER_SUBPIXELS) continue;
            ++compared;
            if (std::hypot(static_cast<double>(x) - real_x, static_cast<double>(y) - real_y) > 1)
                ++off;
        }
    }
    INFO(off << " of " << compared << " positions are off");
    CHECK(compared > 5000);
    CHECK(clipped > 1000);
    CHECK(1000 * off < compared);
}

TEST_CASE("triangles that the near plane and the guard band cut are drawn as in the reference") {
    CELLIST_RANDOM(random, 402u);
    for (const int samples : {1, 4}) {
        const oit::Scene scene = oit::scene_of(triangles_around(random, 60), 0.3F);
        const oit::Frame frame{.scene = scene,
                               .views = {support::frame_unit_sphere({20, 10}, 160, 120)},
                               .quality = {.samples = samples}};
        oit::Renderer renderer(device(), frame);
        renderer.draw();
        const oit::Comparison comparison =
            oit::compare(oit::draw_reference(frame), renderer.image(), renderer.method().depths());
        INFO(samples << " samples");
        CHECK(comparison.fragments > 10'000);
        CHECK(comparison.pixels_with_other_count == 0);
        CHECK(comparison.max_depth_error <= oit::depth_resolution / 2);
        CHECK(comparison.pixels_explained == comparison.pixels_over);
    }
}

}  // namespace
}  // namespace cellist::test
