// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace support {

/// The path of a file that a mesh file names, for example a material library or a buffer. Empty if
/// the file is outside the mesh's folder: an absolute name, a name that leaves the folder by "..",
/// or a link that leads out of it. The file need not exist.
[[nodiscard]] std::optional<std::filesystem::path> path_beside(const std::filesystem::path& mesh,
                                                               const std::string& name);

}  // namespace support
