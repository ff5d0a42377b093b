// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace particles {

bool is_finite(const cl_float4& point) {
    return std::isfinite(point.s[0]) && std::isfinite(point.s[1]) && std::isfinite(point.s[2]);
}

Scene make_scene(std::size_t points, double neighbours, Box box, std::uint32_t seed) {
    Scene scene;
    scene.box = box;
    const double density = static_cast<double>(std::max<std::size_t>(points, 1));
    const double radius = std::cbrt(neighbours / (4.0 / 3.0 * std::numbers::pi * density));
    // In a periodic box, half its side: beyond, a point would meet the same neighbour twice.
    scene.radius = static_cast<float>(std::min(radius, 0.5));

    std::mt19937 random(seed);
    const auto coordinate = [&] { return static_cast<float>(random() >> 8) * 0x1p-24F; };
    scene.points.resize(points);
    for (cl_float4& point : scene.points) point = {{coordinate(), coordinate(), coordinate(), 0}};

    if (points >= 16) {
        constexpr float nan = std::numeric_limits<float>::quiet_NaN();
        constexpr float infinity = std::numeric_limits<float>::infinity();
        scene.points[3] = {{1e7F, -3e6F, 2.5F, 0}};
        scene.points[5] = {{nan, 0.5F, 0.5F, 0}};
        scene.points[8] = {{0.5F, infinity, 0.5F, 0}};
        scene.points[13] = {{nan, nan, -infinity, 0}};
    }
    scene.invalid = static_cast<std::size_t>(
        std::count_if(scene.points.begin(), scene.points.end(),
                      [](const cl_float4& point) { return !is_finite(point); }));
    return scene;
}

}  // namespace particles
