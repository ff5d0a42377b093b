#pragma once

#include <span>

#include "grid/triangle_grid.hpp"
#include "segments.hpp"

namespace triangle_grid {

/// Whether the segment meets any of the triangles, by asking every one, exactly, on the CPU. What
/// counts as meeting is defined in segment.clh.
[[nodiscard]] bool meets_any(const Segment& segment, std::span<const grid::GridTriangle> triangles);

}  // namespace triangle_grid
