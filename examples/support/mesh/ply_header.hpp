// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace support {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] std::size_t size_bytes(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< of lists
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    [[nodiscard]] const PlyProperty* find(std::string_view property) const;
};

struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian };
    Format format = Format::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_begin = 0;   ///< byte after the header's last line
    std::uint64_t data_line = 1;  ///< number of the line there
    std::uint64_t texture_files =
        0;  ///< named by comments ("comment TextureFile", as MeshLab writes)

    [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// Reads the header of a PLY file. Comments may be on any line; lines end in LF, CR or CRLF. Throws
/// InputError with the number of the line that is wrong.
[[nodiscard]] PlyHeader read_ply_header(const std::filesystem::path& path, std::string_view text);

}  // namespace support
