// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "grid/rays.hpp"

namespace triangle_grid {

struct Segment {
    glm::vec3 from, to;
};

/// What is known to break walks through grids and tests of triangles. Segment i of make_segments is
/// of kind i % kinds.size().
inline constexpr std::array<std::string_view, 9> kinds{"between random points",
                                                       "along an axis",
                                                       "in the face between cells",
                                                       "along a diagonal of cells",
                                                       "from outside of the grid",
                                                       "from far outside",
                                                       "through a corner of the mesh",
                                                       "along an edge of the mesh",
                                                       "of length 0"};

[[nodiscard]] std::vector<Segment> make_segments(std::size_t count, const grid::GridCells& cells,
                                                 std::span<const grid::GridTriangle> triangles,
                                                 std::uint32_t seed);
/// All of the first kind.
[[nodiscard]] std::vector<Segment> make_random_segments(std::size_t count,
                                                        const grid::GridCells& cells,
                                                        std::uint32_t seed);

/// The same segments as grid::Rays takes them.
[[nodiscard]] std::vector<grid::GridSegment> to_device(std::span<const Segment> segments);

/// Triangles without area: points, and corners in a line. Nothing may come of them.
void add_flat_triangles(std::vector<grid::GridTriangle>& triangles);

}  // namespace triangle_grid
