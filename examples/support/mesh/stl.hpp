// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace support {

/// Whether a file has just the size that a binary STL file of its number of triangles has.
[[nodiscard]] bool is_binary_stl(std::string_view text);

}  // namespace support
