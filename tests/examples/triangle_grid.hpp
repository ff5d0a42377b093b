// SPDX-License-Identifier: MIT
// What tests of triangle grids share: meshes, and a comparison with every triangle in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <cellist/cellist.hpp>

#include "grid/rays.hpp"
#include "grid/triangle_grid.hpp"
#include "segments.hpp"

namespace cellist::test {

using grid::GridTriangle;
using triangle_grid::Segment;
using Triangles = std::vector<GridTriangle>;

/// What a grid answers about segments.
struct GridAnswers {
    std::vector<cl_uint> any;
    std::vector<grid::GridHit> closest;
    std::uint32_t invalid;  ///< segments that are not finite
};

/// Builds the grid, validates its lists, and asks it.
GridAnswers ask(grid::TriangleGrid& grid, const std::vector<Segment>& segments);
GridAnswers ask(const Triangles& triangles, const grid::GridCells& cells,
                const std::vector<Segment>& segments, Storage storage);

/// Requires that all answers are those of asking every triangle: whether there is a hit, exactly;
/// the closest one by distances in double; its distance and barycentric weights to within roundings
/// of floats. Weights of segments that are very long beside the triangle are not compared. Skips
/// on devices without double.
void require_right(const Triangles& triangles, const std::vector<Segment>& segments,
                   const GridAnswers& answers);
/// With two storages.
void require_same(const Triangles& triangles, const grid::GridCells& cells,
                  const std::vector<Segment>& segments);
/// In cells around the triangles, with segments of every kind.
void require_same(const Triangles& triangles, int longest, std::size_t segments = 900);

/// A square in the plane z = height, in n x n squares of two triangles each.
Triangles sheet(int n, float height);

/// Every 40th of the 49,152 triangles of a knot, or as many as `step` says.
Triangles part_of_knot(std::size_t step = 40);

}  // namespace cellist::test
