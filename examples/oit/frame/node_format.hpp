// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace oit {

/// How colour and depth lie in the nodes of lists.
enum class NodeFormat {
    float32,      ///< float colour, float depth
    rgba8,        ///< 8-bit colour, float depth
    rgba16f,      ///< half colour, float depth
    rgba8_d24c8,  ///< 8-bit colour, 24-bit depth and 8 bits of coverage in one word
    rgb565_d16,   ///< 5, 6 and 5 bits of colour and 16-bit depth in one word
};

/// What of depth is divided evenly by 16 and 24 bits.
enum class DepthScale {
    linear,    ///< depth itself
    reversed,  ///< 1 / depth: finest in front
};

struct NodeFormatName {
    NodeFormat format;
    std::string_view name;
};

/// All formats, by the names that command lines have for them.
inline constexpr std::array<NodeFormatName, 5> node_formats{{
    {NodeFormat::float32, "float"},
    {NodeFormat::rgba8, "rgba8"},
    {NodeFormat::rgba16f, "rgba16f"},
    {NodeFormat::rgba8_d24c8, "rgba8_d24c8"},
    {NodeFormat::rgb565_d16, "rgb565_d16"},
}};

/// Whether depth is kept as a float: as it was computed, or 1 / depth.
[[nodiscard]] constexpr bool has_float_depth(NodeFormat format) {
    return format != NodeFormat::rgba8_d24c8 && format != NodeFormat::rgb565_d16;
}

[[nodiscard]] constexpr std::string_view name_of(NodeFormat format) {
    for (const NodeFormatName& entry : node_formats)
        if (entry.format == format) return entry.name;
    return {};
}

}  // namespace oit
