// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "grid/triangle_grid.hpp"

namespace grid {

/// Whether the segment meets any of the triangles, by asking every one, exactly, on the CPU. What
/// counts as meeting is defined in segment.clh.
[[nodiscard]] bool meets_any(const glm::vec3& from, const glm::vec3& to,
                             std::span<const GridTriangle> triangles);

}  // namespace grid
