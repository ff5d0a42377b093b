// SPDX-License-Identifier: MIT
#pragma once

#include "frame/node_layout.hpp"

namespace cellist::test {

/// How far a channel of a colour in a node is from the fragment's, at most.
inline double colour_error(const oit::NodeLayout& layout, const oit::FrameFeatures& features) {
    const auto most = static_cast<double>(features.colour_max);
    // Half a step of the square root r, at r = 1: (r + h)^2 - r^2.
    const auto of_root = [&](double steps) { return most * (1 / steps + 0.25 / (steps * steps)); };
    switch (layout.format) {
        case oit::NodeFormat::float32:
            return 0;
        case oit::NodeFormat::rgba16f:
            return most * 0x1p-11;
        case oit::NodeFormat::rgb565_d16:
            return of_root(31);
        default:
            return of_root(255);
    }
}

/// The same for an opacity.
inline double alpha_error(const oit::NodeLayout& layout) {
    const std::uint32_t bits = layout.alpha.bits;
    if (bits == 0 || bits == 32) return 0;
    return bits == 16 ? 0x1p-12 : 0.5 / 255;
}

}  // namespace cellist::test
