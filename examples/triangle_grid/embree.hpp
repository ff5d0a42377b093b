// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grid/triangle_grid.hpp"
#include "segments.hpp"

namespace triangle_grid {

struct EmbreeAnswers {
    std::vector<std::uint8_t> hits;  ///< 1 where a segment meets a triangle
    double build_ms, trace_ms;
};

/// Asks Embree whether the segments meet a triangle, on all cores, in its robust mode. The time of
/// the build is that of a rebuild for triangles that have moved. Throws Error without Embree.
[[nodiscard]] EmbreeAnswers ask_embree(std::span<const grid::GridTriangle> triangles,
                                       std::span<const Segment> segments);

}  // namespace triangle_grid
