// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "mesh.hpp"

namespace support {

struct MtlMaterial {
    MeshMaterial look;
    std::uint64_t textures = 0;  ///< of its colour and opacity
};

using MtlLibrary = std::map<std::string, MtlMaterial, std::less<>>;

/// Adds the materials of an MTL file by their names; a repeated name keeps its first material. `Kd`
/// is linear RGB. `d` or 1 - `Tr` is the opacity; `d` wins where a material has both. Returns
/// whether the file ends within a line, so that it may be truncated. Throws InputError where the
/// file cannot be read or has a malformed statement.
bool read_mtl(const std::filesystem::path& path, MtlLibrary& library);

}  // namespace support
