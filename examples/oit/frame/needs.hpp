#pragma once

#include <cstdint>
#include <string>

#include "frame/frame.hpp"

namespace oit {

/// What a frame requires of the kernels; they are compiled for that and no more.
struct Needs {
    bool opaque = false;        ///< something hides fragments
    bool opacities = false;     ///< vertices of transparent surfaces have opacities
    bool tints = false;         ///< vertices have tints
    bool alpha_varies = false;  ///< fragments differ in opacity
    float alpha = 1;            ///< their opacity, where they do not
    std::uint32_t blends = 0;   ///< a bit, 1 << Blend, for each kind of the transparent surfaces
    bool shines = false;        ///< a medium has a glossy surface, which adds fragments
    float least_depth = 0;      ///< of fragments, at least
    float greatest_depth = 0;   ///< of fragments, at most
    float colour_max = 1;       ///< of fragments, in any channel, at most

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

[[nodiscard]] Needs needs_of(const Frame& frame);

/// How many floats hold what is blended of a pixel (see screen.clh).
[[nodiscard]] std::uint32_t state_floats(const Quality& quality, const Needs& needs);

/// The macros that kernels of this frame are compiled with.
[[nodiscard]] std::string defines_of(const Frame& frame, const Needs& needs);

}  // namespace oit
