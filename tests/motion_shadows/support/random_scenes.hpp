// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "scene.hpp"

namespace cellist::test {

/// From low to high.
inline double between(std::mt19937& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

inline glm::vec3 point(std::mt19937& random, double half) {
    return {between(random, -half, half), between(random, -half, half),
            between(random, -half, half)};
}

/// Triangles in a box of 2 m, under a light 3 m above its centre. Sizes and ways are from 1 mm to
/// 1 m.
inline motion::Scene random_scene(std::mt19937& random, std::size_t triangles, bool is_spot) {
    motion::Scene scene;
    scene.name = is_spot ? "random, spot light" : "random, parallel light";
    for (std::size_t i = 0; i < triangles; ++i) {
        const double size = std::pow(10, between(random, -3, 0));
        const double way = std::pow(10, between(random, -3, 0));
        const glm::vec3 centre = point(random, 1), move = point(random, way);
        const auto first = static_cast<std::uint32_t>(scene.begin.size());
        for (int k = 0; k < 3; ++k) {
            scene.begin.push_back(centre + point(random, size));
            // Some turn and change their shape.
            scene.end.push_back(scene.begin.back() + move +
                                (i % 3 == 0 ? point(random, size) : glm::vec3(0)));
        }
        scene.triangles.emplace_back(first, first + 1, first + 2);
        scene.colours.emplace_back(255);
    }
    scene.light.is_spot = is_spot;
    scene.light.position = {0.3, 4, 0.2};
    scene.light.target = {0, 0, 0};
    scene.light.field_degrees = 40;
    scene.light.side = 2.4;
    scene.eye = {1, 2, 4};
    return scene;
}

}  // namespace cellist::test
