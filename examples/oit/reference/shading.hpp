// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "raster/view.hpp"
#include "scene/lighting.hpp"
#include "scene/material.hpp"

namespace oit {

/// Colours of surfaces, floor and background: shading.clh in double precision.
class ReferenceShading {
public:
    /// Refers to both.
    ReferenceShading(const Lighting& lighting, const raster::View& view)
        : lighting_(lighting), view_(view) {}

    [[nodiscard]] glm::dvec3 ray(int x, int y) const;
    /// A surface with a normal of any length, seen in a pixel.
    [[nodiscard]] glm::dvec3 surface(const glm::dvec3& tint, double gloss, glm::dvec3 normal,
                                     bool front, int x, int y) const;
    [[nodiscard]] glm::dvec3 background(int y) const;
    [[nodiscard]] glm::dvec3 floor(int x, int y) const;

private:
    const Lighting& lighting_;
    const raster::View& view_;
};

[[nodiscard]] inline glm::dvec3 to_double(const cl_float (&v)[3]) {
    return glm::vec3(v[0], v[1], v[2]);
}

}  // namespace oit
