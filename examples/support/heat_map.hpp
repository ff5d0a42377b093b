// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace support {

/// Values that are shown as colours, from 0 to the greatest one.
struct HeatMap {
    std::span<const double> values;  ///< row by row from the top; finite and not negative
    int width, height;               ///< in pixels, at least 1
    std::string caption;             ///< what the values are: letters and spaces
    bool are_counts = true;          ///< values are whole numbers, and so are the labels
};

/// 8-bit sRGB, row by row from the top.
struct HeatPicture {
    std::vector<std::uint8_t> bytes;  ///< red, green and blue of each pixel
    int width, height;
};

/// A part from 0 to 1 as a colour in sRGB: black, violet, red, orange, pale yellow. The lightness
/// rises evenly ("inferno" of matplotlib, by S. van der Walt and N. Smith).
[[nodiscard]] std::array<std::uint8_t, 3> heat_colour(double part);

/// The map, and a scale below it. The picture is wider than the map if the labels need the room.
[[nodiscard]] HeatPicture heat_picture(const HeatMap& map);

/// Writes heat_picture() in an 8-bit format, and the values alone, as grey, in a format of floats.
/// Throws as write_file() does.
void write_heat_map(const std::filesystem::path& path, const HeatMap& map);

}  // namespace support
