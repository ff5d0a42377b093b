// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "grid/triangle_grid.hpp"
#include "mesh.hpp"

namespace triangle_grid {

/// A closed knot in the unit sphere: a mesh for when there is no file.
[[nodiscard]] support::Mesh make_knot();

[[nodiscard]] std::vector<grid::GridTriangle> triangles_of(const support::Mesh& mesh);

}  // namespace triangle_grid
