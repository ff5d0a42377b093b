// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <string>

#include "frame/frame.hpp"

namespace oit {

/// The features that a frame uses. Kernels are compiled for these and no more.
struct FrameFeatures {
    bool opaque = false;          ///< something hides fragments
    bool stores_opaque = false;   ///< as Frame::stores_opaque(), and some fragments hide all behind
    bool opacities = false;       ///< vertices of transparent surfaces have opacities
    bool tints = false;           ///< vertices have tints
    bool alpha_varies = false;    ///< fragments differ in opacity
    float alpha = 1;              ///< their opacity, where they do not
    std::uint32_t blends = 0;     ///< a bit, 1 << Blend, for each kind of the transparent surfaces
    bool has_highlights = false;  ///< a medium is glossy; its highlights are fragments
    float least_depth = 0;        ///< of fragments, at least
    float greatest_depth = 0;     ///< of fragments, at most
    float colour_max = 1;         ///< of fragments, in any channel, at most

    [[nodiscard]] bool has(Blend blend) const {
        return (blends >> static_cast<std::uint32_t>(blend) & 1) != 0;
    }
    /// Fragments differ in what they do to the light behind.
    [[nodiscard]] bool blend_varies() const;
    /// Red, green and blue light pass differently.
    [[nodiscard]] bool transmittance_is_coloured() const {
        return has(Blend::multiplicative) || has(Blend::absorb) || has(Blend::user);
    }
};

[[nodiscard]] FrameFeatures features_of(const Frame& frame);

/// How many floats hold what is blended of a pixel (see blend.clh).
[[nodiscard]] std::uint32_t state_floats(const Quality& quality, const FrameFeatures& features);

/// The line that defines a macro.
[[nodiscard]] std::string define(const std::string& name, const std::string& value);
[[nodiscard]] std::string define(const std::string& name, std::integral auto value) {
    return define(name, std::to_string(value));
}

/// The macros that kernels of this frame are compiled with.
[[nodiscard]] std::string defines_of(const Frame& frame, const FrameFeatures& features);

}  // namespace oit
