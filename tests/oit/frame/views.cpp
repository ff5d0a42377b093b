// SPDX-License-Identifier: MIT
// A lens and sub-pixels move a view as a pinhole camera at another place sees it.
#include "frame/views.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "camera.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

// Where a view sees a point, in pixels from the upper left corner.
glm::dvec2 seen(const raster::View& view, const glm::dvec3& p) {
    const auto row = [&p](const cl_float(&r)[4]) {
        return static_cast<double>(r[0]) * p.x + static_cast<double>(r[1]) * p.y +
               static_cast<double>(r[2]) * p.z + static_cast<double>(r[3]);
    };
    return glm::dvec2(row(view.row_x), row(view.row_y)) / (row(view.row_w) * RASTER_SUBPIXELS) +
           0.5 * glm::dvec2(view.width, view.height);
}

glm::dvec3 vector(const cl_float (&v)[3]) { return glm::vec3(v[0], v[1], v[2]); }

// The point at a depth in the middle of a pixel, by the view's ray.
glm::dvec3 point_at(const raster::View& view, double x, double y, double depth) {
    return vector(view.eye) +
           depth * (vector(view.ray_origin) + x * vector(view.ray_x) + y * vector(view.ray_y));
}

}  // namespace

TEST_CASE("a place on the lens moves points by their depth, and keeps what is in focus") {
    CELLIST_RANDOM(random, 411u);
    std::uniform_real_distribution<double> part(-1, 1);
    for (const raster::View& view : support::frame_unit_sphere(
             {.azimuth_degrees = 25, .elevation_degrees = 40}, 320, 200, 0.3))
        for (const double focus : {3.0, 0.5, 1e3, -4.0, HUGE_VAL})
            for (int i = 0; i < 50; ++i) {
                const oit::Lens lens{.radius = 0.2, .focus = focus};
                const glm::dvec2 place(part(random), part(random));
                const raster::View moved = oit::through_lens(view, lens, place);
                const double x = 160 + 100 * part(random), y = 100 + 60 * part(random);
                const double depth = 3 + part(random);
                const glm::dvec3 p = point_at(view, x, y, depth);
                const glm::dvec2 expected = seen(view, p) + oit::focal_length_pixels(view) *
                                                                lens.radius * place *
                                                                (1 / focus - 1 / depth);
                INFO("focus " << focus << ", depth " << depth);
                CHECK(glm::length(seen(moved, p) - expected) < 2e-3 * (1 + 1 / std::abs(focus)));
                // The eye is on the lens, and its rays go where it sees points.
                CHECK(glm::length(vector(moved.eye) - vector(view.eye)) ==
                      Approx(lens.radius * glm::length(place)).epsilon(1e-4).margin(1e-5));
                const glm::dvec2 ray = seen(moved, point_at(moved, x, y, depth));
                CHECK(glm::length(ray - glm::dvec2(x + 0.5, y + 0.5)) < 2e-3);
            }
}

TEST_CASE("a view moved by pixels sees the same points at other places") {
    const raster::View view =
        support::frame_unit_sphere({.azimuth_degrees = 100, .elevation_degrees = -20}, 64, 48);
    const glm::dvec2 by(0.25, -0.375);
    const raster::View moved = oit::moved_by(view, by);
    for (const glm::dvec3& p : {glm::dvec3(0.1, 0.2, 0.3), glm::dvec3(-0.5, 0.4, 0)}) {
        CHECK(glm::length(seen(moved, p) - (seen(view, p) - by)) < 1e-4);
        const glm::dvec2 at = seen(moved, p) - 0.5;
        const glm::dvec2 ray = seen(moved, point_at(moved, at.x, at.y, 3.0));
        CHECK(glm::length(ray - seen(moved, p)) < 1e-4);
    }
}

TEST_CASE("places on the lens are spread evenly over it") {
    constexpr std::size_t count = 1024;
    glm::dvec2 sum(0), squares(0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2 place = oit::place_on_disc(i, count);
        CHECK(glm::length(place) <= 1);
        sum += place;
        squares += place * place;
    }
    CHECK(glm::length(sum) / count < 1e-3);
    // Of a disc of radius 1: a quarter along each axis.
    CHECK(squares.x / count == Approx(0.25).margin(1e-3));
    CHECK(squares.y / count == Approx(0.25).margin(1e-3));
}

}  // namespace cellist::test
