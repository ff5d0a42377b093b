// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "raster/view.hpp"

namespace support {

/// A camera that looks at the origin from an orbit around it, with y up.
struct Orbit {
    double azimuth_degrees = 0;    ///< 0 looks from +z, 90 from +x
    double elevation_degrees = 0;  ///< -90 to 90; positive looks down
    double zoom = 1;               ///< divides the distance from the origin
};

/// The direction and the zoom 1 of an eye that looks at `target`.
[[nodiscard]] Orbit orbit_of(const glm::dvec3& eye, const glm::dvec3& target);

/// The eye on an orbit around `target`, at `distance` where the zoom is 1.
[[nodiscard]] glm::dvec3 eye_on(const Orbit& orbit, const glm::dvec3& target, double distance);

/// The perspective view of an orbit camera that frames a sphere of radius 1 in an image of
/// width x height pixels, where its zoom is 1. The field of view is 30 degrees along the shorter
/// side.
[[nodiscard]] raster::View frame_unit_sphere(const Orbit& orbit, int width, int height);

/// The same for two eyes, left and right, at this distance from each other; both see the origin in
/// the middle of the image.
[[nodiscard]] std::vector<raster::View> frame_unit_sphere(const Orbit& orbit, int width, int height,
                                                          double eye_separation);

/// The perspective view of a camera at `eye` that looks at `target`, with y up; along y, z is up.
/// The field of view is along the shorter side.
[[nodiscard]] raster::View look_at(const glm::dvec3& eye, const glm::dvec3& target,
                                   double field_degrees, int width, int height);

/// The view along parallel lines from `eye` towards `target`, of a square around the line between
/// them with this side. Depths of fragments are 1.
[[nodiscard]] raster::View look_along(const glm::dvec3& eye, const glm::dvec3& target, double side,
                                      int pixels);

}  // namespace support
