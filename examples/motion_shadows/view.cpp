// SPDX-License-Identifier: MIT
#include "view.hpp"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "camera.hpp"

namespace motion {
namespace {

cl_float4 float4(const glm::dvec4& v) {
    return {{static_cast<cl_float>(v.x), static_cast<cl_float>(v.y), static_cast<cl_float>(v.z),
             static_cast<cl_float>(v.w)}};
}

// A view of the rasteriser counts sub-pixels; division by a power of two is exact.
cl_float4 in_pixels(const cl_float (&row)[4]) {
    constexpr cl_float pixels = 1.0F / RASTER_SUBPIXELS;
    return {{row[0] * pixels, row[1] * pixels, row[2] * pixels, row[3] * pixels}};
}

View view_of(const raster::View& from, const glm::dvec3& eye, const glm::dvec3& target,
             bool is_parallel) {
    const glm::dvec3 axis = glm::normalize(target - eye);
    View view{};
    view.row_x = in_pixels(from.row_x);
    view.row_y = in_pixels(from.row_y);
    view.row_w = {{from.row_w[0], from.row_w[1], from.row_w[2], from.row_w[3]}};
    view.row_depth = is_parallel ? float4(glm::dvec4(axis, -glm::dot(axis, eye))) : view.row_w;
    view.near_depth = is_parallel ? 0.0F : from.near_depth;
    const glm::dvec3 x(view.row_x.s[0], view.row_x.s[1], view.row_x.s[2]);
    view.pixel = static_cast<cl_float>(1 / glm::length(x - glm::dot(x, axis) * axis));
    view.is_parallel = is_parallel ? 1 : 0;
    view.width = from.width;
    view.height = from.height;
    return view;
}

}  // namespace

View camera_view(const glm::dvec3& eye, const glm::dvec3& target, double field_degrees, int width,
                 int height) {
    return view_of(support::look_at(eye, target, field_degrees, width, height), eye, target, false);
}

View light_view(const support::Light& light, int side) {
    const raster::View view =
        light.is_spot
            ? support::look_at(light.position, light.target, light.field_degrees, side, side)
            : support::look_along(light.position, light.target, light.side, side);
    return view_of(view, light.position, light.target, !light.is_spot);
}

}  // namespace motion
