#pragma once

#include <functional>

#include <glm/vec3.hpp>

#include "build.hpp"

namespace motion {

/// A solid as a signed distance: negative inside, and never more than `slack` above the distance to
/// the surface.
struct Solid {
    std::function<double(const glm::dvec3&)> distance;
    glm::dvec3 low{0}, high{0};  ///< a box that holds it
    double slack = 0;
};

/// The surface of a solid, with one vertex in each cubic cell of this side that the surface crosses:
/// Gibson, "Constrained Elastic Surface Nets" (MICCAI 1998), without the relaxation. Vertices move
/// onto the surface instead.
[[nodiscard]] Shape make_surface(const Solid& solid, double cell);

}  // namespace motion
