// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace support {

/// "mesh 'a.obj'": how messages name a file. Control characters become '?', so that a message
/// keeps to one line.
[[nodiscard]] std::string quoted(const std::string& kind, const std::filesystem::path& path);

/// The bytes of a regular file. `kind` is for messages ("mesh", "texture"). Never waits: refuses a
/// FIFO, a socket or a device. Throws InputError where the file is missing, is not a regular file,
/// cannot be read, is empty, or is larger than `limit_bytes`.
[[nodiscard]] std::string read_file(const std::string& kind, const std::filesystem::path& path,
                                    std::uint64_t limit_bytes);

}  // namespace support
