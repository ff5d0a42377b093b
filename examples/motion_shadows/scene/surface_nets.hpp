// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <glm/vec3.hpp>

#include "build.hpp"

namespace motion {

/// A solid. The distance is negative inside and has a slope of at most 1.1, so that no surface is
/// nearer than the distance divided by 1.1.
struct Solid {
    std::function<double(const glm::dvec3&)> distance;
    glm::dvec3 low{0}, high{0};  ///< a box that holds it
};

/// The closed surface of a solid, with a vertex in each cubic cell of this side that the surface
/// crosses: Gibson, "Constrained Elastic Surface Nets" (MICCAI 1998). Vertices move onto the
/// surface.
[[nodiscard]] Shape make_surface(const Solid& solid, double cell);

}  // namespace motion
