// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include "device_types.hpp"
#include "light.hpp"

namespace motion {

/// A camera with y up; the field of view is along the shorter side.
[[nodiscard]] View camera_view(const glm::dvec3& eye, const glm::dvec3& target,
                               double field_degrees, int width, int height);

/// The image of a light: a square.
[[nodiscard]] View light_view(const support::Light& light, int side);

}  // namespace motion
