// SPDX-License-Identifier: MIT
#include "reference/shading.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace oit {
namespace {

using glm::dvec3;

double smooth(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double square_wave_integral(double x) { return 1 - 2 * std::abs(x / 2 - std::floor(x / 2) - 0.5); }

double square_wave_mean(double middle, double width) {
    return (square_wave_integral(middle + width / 2) - square_wave_integral(middle - width / 2)) /
           width;
}

}  // namespace

dvec3 ReferenceShading::ray(int x, int y) const {
    return to_double(view_.ray_origin) + static_cast<double>(x) * to_double(view_.ray_x) +
           static_cast<double>(y) * to_double(view_.ray_y);
}

dvec3 ReferenceShading::surface(const dvec3& tint, double gloss, dvec3 normal, bool front, int x,
                                int y) const {
    if (!front) normal = -normal;
    normal /= std::sqrt(glm::dot(normal, normal) + 1e-6);
    const dvec3 to_eye = -glm::normalize(ray(x, y));
    const dvec3 to_key = to_double(lighting_.key_direction);
    dvec3 half_way = to_eye + to_key;
    half_way /= std::sqrt(glm::dot(half_way, half_way) + 1e-6);

    const dvec3 ambient =
        glm::mix(to_double(lighting_.ground), to_double(lighting_.sky), 0.5 + 0.5 * normal.y);
    const dvec3 key = to_double(lighting_.key);
    const double diffuse = std::max(0.0, glm::dot(normal, to_key));
    const double highlight = std::pow(std::max(0.0, glm::dot(normal, half_way)), 32);
    const double rim = std::pow(1 - std::max(0.0, glm::dot(normal, to_eye)), 3);
    return tint * (ambient + diffuse * key) + gloss * highlight * key +
           rim * to_double(lighting_.rim);
}

dvec3 ReferenceShading::background(int y) const {
    return glm::mix(to_double(lighting_.background_top), to_double(lighting_.background_bottom),
                    (y + 0.5) / view_.height);
}

dvec3 ReferenceShading::floor(int x, int y) const {
    const dvec3 r = ray(x, y);
    const double height = r.y < 0 ? std::min(r.y, -1e-4) : std::max(r.y, 1e-4);
    const dvec3 eye = to_double(view_.eye);
    const double distance = (static_cast<double>(lighting_.floor_height) - eye.y) / height;
    const dvec3 hit = eye + distance * r;
    const dvec3 step_x = to_double(view_.ray_x), step_y = to_double(view_.ray_y);
    const dvec3 across = distance * (step_x - r * (step_x.y / height));
    const dvec3 down = distance * (step_y - r * (step_y.y / height));
    const double squares = 1 / static_cast<double>(lighting_.floor_square);
    const auto mean = [&](int axis) {
        const double width =
            std::clamp(squares * (std::abs(across[axis]) + std::abs(down[axis])), 1e-2, 1e3);
        return square_wave_mean(squares * hit[axis], width);
    };
    const double checker = 0.5 + 0.5 * mean(0) * mean(2);
    const double from_axis = std::hypot(hit.x, hit.z);
    const auto shadow_part = [&](int i, double at) {
        return (at - static_cast<double>(lighting_.floor_shadow_centre[i])) /
               static_cast<double>(lighting_.floor_shadow_radius[i]);
    };
    const double shadow =
        1 - static_cast<double>(lighting_.floor_shadow) *
                smooth(1 - std::hypot(shadow_part(0, hit.x), shadow_part(1, hit.z)));
    const auto begin = static_cast<double>(lighting_.floor_fade_begin);
    const auto end = static_cast<double>(lighting_.floor_fade_end);
    const double fade = smooth((from_axis - begin) / (end - begin));
    const dvec3 paint =
        glm::mix(to_double(lighting_.floor_dark), to_double(lighting_.floor_light), checker);
    return glm::mix(paint * shadow, background(y), fade);
}

}  // namespace oit
