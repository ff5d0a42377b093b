#pragma once

#include <string>
#include <string_view>

#include "raw_mesh.hpp"

namespace support {

/// A mesh as bytes, for another process of this program.
[[nodiscard]] std::string bytes_of(const RawMesh& mesh);

/// The mesh that bytes_of() took. Throws InputError where the bytes are not those of a mesh whose
/// arrays match.
[[nodiscard]] RawMesh raw_mesh_from(std::string_view bytes);

}  // namespace support
