// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/cellist.hpp>

namespace oit {

/// What a fragment does to the light that comes from behind it. Kernels have the same numbers as
/// OIT_OPAQUE, OIT_OVER and so on.
enum class Blend : cl_uint {
    opaque,          ///< hides it
    over,            ///< covers the part alpha of it (Porter and Duff 1984)
    additive,        ///< adds alpha * colour to it
    multiplicative,  ///< filters it: multiplies it by the tint, to the part alpha
    absorb,          ///< front faces enter and back faces leave a medium (Beer-Lambert)
    user,            ///< the function that the user wrote
};

/// How the colour of a surface comes about.
enum class Paint : cl_uint { shaded, floor };

/// A surface. Colours are linear.
struct Material {
    /// Under Blend::absorb, light passes through a unit of length to the part
    /// 1 - alpha + alpha * front_tint.
    cl_float front_tint[3];
    cl_float back_tint[3];
    cl_float alpha;  ///< opacity, 0 to 1
    cl_float gloss;  ///< strength of the highlight
    cl_uint blend;   ///< Blend
    cl_uint paint;   ///< Paint
};
CELLIST_STRUCT(Material, front_tint, back_tint, alpha, gloss, blend, paint);

}  // namespace oit
