// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "raw_mesh.hpp"

namespace support {

/// A mesh as bytes, for another process of this program.
[[nodiscard]] std::string bytes_of(const RawMesh& mesh);

/// The inverse of bytes_of(). Throws InputError where the bytes are not a mesh with arrays of
/// matching sizes.
[[nodiscard]] RawMesh raw_mesh_from(std::string_view bytes);

}  // namespace support
