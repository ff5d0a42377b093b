// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

namespace support {

/// A light that casts shadows: a spot light, or parallel light in a square.
struct Light {
    bool is_spot = true;
    glm::dvec3 position{0, 1, 0};
    glm::dvec3 target{0};
    double field_degrees = 60;  ///< of a spot light
    double side = 2;            ///< of the square that parallel light falls through
    glm::vec3 intensity{1};     ///< in W/sr, or in W/m2 for parallel light; linear RGB
};

}  // namespace support
