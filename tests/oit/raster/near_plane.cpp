// SPDX-License-Identifier: MIT
// Surfaces that pass behind the eye are cut at the near plane, and surfaces of any size are drawn.
#include <cmath>

#include <glm/geometric.hpp>

#include "camera.hpp"
#include "oit/support/screen.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

glm::dvec3 vector(const cl_float (&v)[3]) { return glm::vec3(v[0], v[1], v[2]); }

// A square in the plane y = height with the given half side, of 2 * n * n triangles.
support::Mesh square(float height, float half_side, int n) {
    support::Mesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const auto at = [&](int k) {
                return half_side * (2 * static_cast<float>(k) / static_cast<float>(n) - 1);
            };
            mesh.positions.emplace_back(at(i), height, at(j));
            mesh.normals.emplace_back(0.0F, 1.0F, 0.0F);
        }
    const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            mesh.triangles.push_back({index(i, j), index(i, j + 1), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i + 1, j)});
        }
    return mesh;
}

// Compares with the rays' exact hits. Pixels near the square's border and near the near plane are
// left out, for vertices are snapped to 1/256 pixel.
// `depth_error` is relative, for planes seen face on.
void require_square(float height, float half_side, int n, const support::Orbit& orbit,
                    double depth_error = 1e-4) {
    INFO("height " << height << ", half side " << half_side << ", " << n << " cells a side, view "
                   << orbit.azimuth_degrees << ", " << orbit.elevation_degrees);
    const raster::View view = support::frame_unit_sphere(orbit, 160, 120);
    const Coverage coverage = coverage_of(square(height, half_side, n), view);
    const glm::dvec3 eye = vector(view.eye);
    int compared = 0, wrong = 0, wrong_depth = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec3 ray = vector(view.ray_origin) +
                                   static_cast<double>(x) * vector(view.ray_x) +
                                   static_cast<double>(y) * vector(view.ray_y);
            const auto pixel = static_cast<std::size_t>(y * view.width + x);
            const double depth = (static_cast<double>(height) - eye.y) / ray.y;
            const glm::dvec3 hit = eye + depth * ray;
            const double reach =
                std::max(std::abs(hit.x), std::abs(hit.z)) / static_cast<double>(half_side);
            const double near_ratio = depth / static_cast<double>(view.near_depth);
            const double slack = 0.02 + 0.02 * std::abs(depth) / static_cast<double>(half_side);
            const bool close_call = std::abs(reach - 1) < slack || std::abs(near_ratio - 1) < 0.1 ||
                                    std::abs(ray.y) < 2e-3;
            if (close_call) continue;
            const bool hits = reach < 1 && near_ratio > 1;
            ++compared;
            if (coverage.counts[pixel] != (hits ? 1u : 0u)) ++wrong;
            // Snapping moves an edge by 1/512 pixel, and the plane's depth with it, by more the
            // steeper it is seen.
            const double step = glm::length(vector(view.ray_y)) / std::abs(ray.y);
            if (hits && std::abs(static_cast<double>(coverage.depths[pixel]) / depth - 1) >
                            depth_error + 0.02 * step)
                ++wrong_depth;
        }
    CHECK(compared > 12000);
    CHECK(wrong == 0);
    CHECK(wrong_depth == 0);
}

TEST_CASE("a plane that passes under the eye is cut where it should be") {
    for (const int n : {1, 7, 60})
        for (const double elevation : {3.0, 25.0, -15.0})
            require_square(-0.4F, 40.0F, n,
                           {.azimuth_degrees = 33, .elevation_degrees = elevation});
}

TEST_CASE("a plane of enormous size does not overflow") {
    // A corner at 10^6 is known to 0.06 only, and what is cut from it at the near plane is no
    // better.
    require_square(-0.4F, 1e3F, 1, {.azimuth_degrees = 10, .elevation_degrees = 12});
    require_square(-0.4F, 1e6F, 1, {.azimuth_degrees = 10, .elevation_degrees = 12}, 1.0);
}

TEST_CASE("what lies behind the eye is not drawn") {
    support::Mesh mesh = square(-0.4F, 1.0F, 3);
    for (glm::vec3& p : mesh.positions) p.z += 30;
    const raster::View view = support::frame_unit_sphere({}, 64, 64);
    for (const cl_uint count : coverage_of(mesh, view).counts) REQUIRE(count == 0);
}

}  // namespace
}  // namespace cellist::test
