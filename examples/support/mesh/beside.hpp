#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace support {

/// The path of a file that a mesh file names, for example a material library or a buffer. Nothing
/// where it lies outside the folder of the mesh: an absolute name, a name that leaves the folder by
/// "..", or a link to elsewhere. A file that does not exist may have a path.
[[nodiscard]] std::optional<std::filesystem::path> path_beside(const std::filesystem::path& mesh,
                                                               const std::string& name);

}  // namespace support
