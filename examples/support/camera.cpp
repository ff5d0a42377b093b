// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace support {
namespace {

void set(cl_float (&out)[3], const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) out[i] = static_cast<cl_float>(v[i]);
}

void set_row(cl_float (&row)[4], const glm::dvec3& axis, const glm::dvec3& eye, double scale) {
    for (int i = 0; i < 3; ++i) row[i] = static_cast<cl_float>(scale * axis[i]);
    row[3] = static_cast<cl_float>(-scale * glm::dot(axis, eye));
}

constexpr double radians = std::numbers::pi / 180;

// From the centre of an orbit towards the eye.
glm::dvec3 direction_of(const Orbit& orbit) {
    const double sin_azimuth = std::sin(orbit.azimuth_degrees * radians);
    const double cos_azimuth = std::cos(orbit.azimuth_degrees * radians);
    const double sin_elevation = std::sin(orbit.elevation_degrees * radians);
    const double cos_elevation = std::cos(orbit.elevation_degrees * radians);
    return {sin_azimuth * cos_elevation, sin_elevation, cos_azimuth * cos_elevation};
}

// Unit vectors of a camera in the world.
struct Axes {
    glm::dvec3 right, down, forward;
};

Axes axes_towards(const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 forward = glm::normalize(target - eye);
    const glm::dvec3 up = std::abs(forward.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    return {right, glm::cross(forward, right), forward};
}

// A pinhole camera. `shift` moves its image to the right, for an eye beside the middle: by how much
// of the depth.
raster::View pinhole(const glm::dvec3& eye, const Axes& axes, double focal_pixels, int width,
                     int height, double shift = 0) {
    const double focal = focal_pixels * RASTER_SUBPIXELS;
    raster::View view{};
    set_row(view.row_x, axes.right + shift * axes.forward, eye, focal);
    set_row(view.row_y, axes.down, eye, focal);
    set_row(view.row_w, axes.forward, eye, 1);
    const glm::dvec3 ray_x = axes.right / focal_pixels;
    const glm::dvec3 ray_y = axes.down / focal_pixels;
    set(view.ray_x, ray_x);
    set(view.ray_y, ray_y);
    set(view.ray_origin, axes.forward - shift * axes.right - (0.5 * (width - 1)) * ray_x -
                             (0.5 * (height - 1)) * ray_y);
    set(view.eye, eye);
    view.width = width;
    view.height = height;
    return view;
}

double focal_pixels(double field_degrees, int width, int height) {
    return 0.5 * std::min(width, height) / std::tan(0.5 * field_degrees * radians);
}

// The view from an eye that is moved to the right, with the image moved so that the origin stays in
// its middle.
raster::View frame_from(const Orbit& orbit, int width, int height, double to_the_right) {
    constexpr double field_degrees = 30;
    constexpr double filled = 0.97;  // of the shorter side, by the sphere
    const glm::dvec3 towards_eye = direction_of(orbit);
    const double azimuth = orbit.azimuth_degrees * radians;
    const glm::dvec3 right(std::cos(azimuth), 0, -std::sin(azimuth));
    const double distance =
        1 / std::sin(std::atan(filled * std::tan(0.5 * field_degrees * radians))) / orbit.zoom;
    raster::View view =
        pinhole(distance * towards_eye + to_the_right * right,
                {right, glm::cross(right, towards_eye), -towards_eye},
                focal_pixels(field_degrees, width, height), width, height, to_the_right / distance);
    view.near_depth = static_cast<cl_float>(0.01 * distance);
    return view;
}

}  // namespace

Orbit orbit_of(const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 direction = glm::normalize(eye - target);
    return {.azimuth_degrees = std::atan2(direction.x, direction.z) / radians,
            .elevation_degrees = std::asin(std::clamp(direction.y, -1.0, 1.0)) / radians};
}

glm::dvec3 eye_on(const Orbit& orbit, const glm::dvec3& target, double distance) {
    return target + distance / orbit.zoom * direction_of(orbit);
}

raster::View frame_unit_sphere(const Orbit& orbit, int width, int height) {
    return frame_from(orbit, width, height, 0);
}

std::vector<raster::View> frame_unit_sphere(const Orbit& orbit, int width, int height,
                                            double eye_separation) {
    return {frame_from(orbit, width, height, -0.5 * eye_separation),
            frame_from(orbit, width, height, 0.5 * eye_separation)};
}

raster::View look_at(const glm::dvec3& eye, const glm::dvec3& target, double field_degrees,
                     int width, int height) {
    raster::View view = pinhole(eye, axes_towards(eye, target),
                                focal_pixels(field_degrees, width, height), width, height);
    view.near_depth = static_cast<cl_float>(0.001 * glm::length(target - eye));
    return view;
}

raster::View look_along(const glm::dvec3& eye, const glm::dvec3& target, double side, int pixels) {
    const Axes axes = axes_towards(eye, target);
    const double scale = RASTER_SUBPIXELS * pixels / side;
    raster::View view{};
    set_row(view.row_x, axes.right, eye, scale);
    set_row(view.row_y, axes.down, eye, scale);
    view.row_w[3] = 1;
    set(view.eye, eye);
    view.near_depth = 0.5F;
    view.width = view.height = pixels;
    return view;
}

}  // namespace support
