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

// The view from an eye that is moved to the right, with the image moved so that the origin stays in
// its middle.
raster::View frame_from(const Orbit& orbit, int width, int height, double to_the_right) {
    constexpr double radians = std::numbers::pi / 180;
    constexpr double half_field = 15 * radians;
    constexpr double filled = 0.97;  // of the shorter side, by the sphere
    const double sin_azimuth = std::sin(orbit.azimuth_degrees * radians);
    const double cos_azimuth = std::cos(orbit.azimuth_degrees * radians);
    const double sin_elevation = std::sin(orbit.elevation_degrees * radians);
    const double cos_elevation = std::cos(orbit.elevation_degrees * radians);

    const glm::dvec3 towards_eye(sin_azimuth * cos_elevation, sin_elevation,
                                 cos_azimuth * cos_elevation);
    const glm::dvec3 right(cos_azimuth, 0, -sin_azimuth);
    const glm::dvec3 down = glm::cross(right, towards_eye);
    const double distance = 1 / std::sin(std::atan(filled * std::tan(half_field)));
    const glm::dvec3 eye = distance * towards_eye + to_the_right * right;
    const glm::dvec3 sheared = right - (to_the_right / distance) * towards_eye;

    const double focal_pixels = 0.5 * std::min(width, height) / std::tan(half_field);
    const double focal = focal_pixels * RASTER_SUBPIXELS;
    raster::View view{};
    set_row(view.row_x, sheared, eye, focal);
    set_row(view.row_y, down, eye, focal);
    set_row(view.row_w, -towards_eye, eye, 1);
    const glm::dvec3 ray_x = right / focal_pixels;
    const glm::dvec3 ray_y = down / focal_pixels;
    set(view.ray_x, ray_x);
    set(view.ray_y, ray_y);
    set(view.ray_origin, -towards_eye - (to_the_right / distance) * right -
                             (0.5 * (width - 1)) * ray_x - (0.5 * (height - 1)) * ray_y);
    set(view.eye, eye);
    view.near_depth = static_cast<cl_float>(0.01 * distance);
    view.width = width;
    view.height = height;
    return view;
}

}  // namespace

raster::View frame_unit_sphere(const Orbit& orbit, int width, int height) {
    return frame_from(orbit, width, height, 0);
}

std::vector<raster::View> frame_unit_sphere(const Orbit& orbit, int width, int height,
                                            double eye_separation) {
    return {frame_from(orbit, width, height, -0.5 * eye_separation),
            frame_from(orbit, width, height, 0.5 * eye_separation)};
}

}  // namespace support
