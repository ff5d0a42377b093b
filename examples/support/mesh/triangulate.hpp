#pragma once

#include "raw_mesh.hpp"

namespace support {

/// Splits the polygons into triangles. Drops and counts faces that have less than three corners,
/// that use a vertex that does not exist or is not finite, that have no area, or that cross
/// themselves. clean_mesh() does the rest.
[[nodiscard]] Mesh triangulate(RawMesh raw);

}  // namespace support
