// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace cellist::detail {

/// The library's folder in the user's cache directory: cellist in $XDG_CACHE_HOME, or in
/// $HOME/.cache. Throws Error if neither is set to an absolute path.
[[nodiscard]] std::filesystem::path cache_folder();

/// The content of a file. None if it is not a regular file of up to `size_max` bytes, such as a
/// pipe, or if it cannot be read.
[[nodiscard]] std::optional<std::string> read_file(const std::filesystem::path& path,
                                                   std::size_t size_max);

/// Writes a new file next to `path`, whose name begins with that of `path`. Returns its path.
/// Throws Error.
[[nodiscard]] std::filesystem::path write_unfinished(const std::filesystem::path& path,
                                                     const std::string& text);
/// Replaces a file. A reader sees either the old content or the new one. Throws Error.
void replace_file(const std::filesystem::path& path, const std::string& text);

}  // namespace cellist::detail
