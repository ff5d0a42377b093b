// SPDX-License-Identifier: MIT
#pragma once

#include "raw_mesh.hpp"

namespace support {

/// Splits the polygons into triangles. Drops and counts faces that have fewer than three corners,
/// that use a missing or non-finite vertex, and polygons that have no area or cross themselves.
/// clean_mesh() does the rest.
[[nodiscard]] Mesh triangulate(RawMesh raw);

}  // namespace support
