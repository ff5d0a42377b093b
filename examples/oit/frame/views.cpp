// SPDX-License-Identifier: MIT
#include "frame/views.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace oit {
namespace {

glm::dvec3 direction(const cl_float (&row)[4]) { return glm::vec3(row[0], row[1], row[2]); }

// The part of a row at right angles to the viewing direction: the axis of the image, scaled by the
// focal length in sub-pixels.
glm::dvec3 axis(const cl_float (&row)[4], const raster::View& view) {
    const glm::dvec3 forward = direction(view.row_w);
    return direction(row) - glm::dot(direction(row), forward) * forward;
}

void add_rows(cl_float (&row)[4], double times, const cl_float (&other)[4]) {
    for (int i = 0; i < 4; ++i)
        row[i] = static_cast<cl_float>(static_cast<double>(row[i]) +
                                       times * static_cast<double>(other[i]));
}

void add(cl_float (&v)[3], const glm::dvec3& other) {
    for (int i = 0; i < 3; ++i) v[i] = static_cast<cl_float>(static_cast<double>(v[i]) + other[i]);
}

}  // namespace

raster::View through_lens(const raster::View& view, const Lens& lens, const glm::dvec2& place) {
    const glm::dvec3 axis_x = axis(view.row_x, view), axis_y = axis(view.row_y, view);
    const glm::dvec2 moved = lens.radius * place;
    const glm::dvec3 eye = moved.x * glm::normalize(axis_x) + moved.y * glm::normalize(axis_y);
    raster::View result = view;
    const auto move_row = [&](cl_float(&row)[4], double by, const glm::dvec3& along) {
        // The eye moves, and the image moves so that the depth in focus stays where it is.
        row[3] = static_cast<cl_float>(static_cast<double>(row[3]) - glm::dot(direction(row), eye));
        add_rows(row, by * glm::length(along) / lens.focus, view.row_w);
    };
    move_row(result.row_x, moved.x, axis_x);
    move_row(result.row_y, moved.y, axis_y);
    add(result.ray_origin, -eye / lens.focus);
    add(result.eye, eye);
    return result;
}

raster::View moved_by(const raster::View& view, const glm::dvec2& pixels) {
    raster::View result = view;
    add_rows(result.row_x, -RASTER_SUBPIXELS * pixels.x, view.row_w);
    add_rows(result.row_y, -RASTER_SUBPIXELS * pixels.y, view.row_w);
    for (int i = 0; i < 3; ++i)
        result.ray_origin[i] = static_cast<cl_float>(static_cast<double>(view.ray_origin[i]) +
                                                     pixels.x * static_cast<double>(view.ray_x[i]) +
                                                     pixels.y * static_cast<double>(view.ray_y[i]));
    return result;
}

double focal_length_pixels(const raster::View& view) {
    return glm::length(axis(view.row_x, view)) / RASTER_SUBPIXELS;
}

glm::dvec2 place_on_disc(std::size_t i, std::size_t count) {
    constexpr double golden_angle = std::numbers::pi * (3 - 2.2360679774997896964);
    const double radius = std::sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(count));
    const double angle = golden_angle * static_cast<double>(i);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace oit
