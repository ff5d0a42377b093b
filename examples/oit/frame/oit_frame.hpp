// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/cellist.hpp>

#include "scene/lighting.hpp"

namespace oit {

/// What is the same for all pixels of a frame, as kernels take it.
struct OitFrame {
    Lighting lighting;
    cl_float alpha;        ///< of every fragment, where all have the same
    cl_float least_depth;  ///< of fragments: what quantised depths start at
    cl_float greatest_depth;
    cl_float colour_max;  ///< of fragments: what quantised colours end at
    cl_float epsilon;     ///< blending ends where no more than this part of the light passes
    cl_uint first_pixel;  ///< of those that are blended at once, where memory is bounded
    cl_uint end_pixel;
};
CELLIST_STRUCT(OitFrame, lighting, alpha, least_depth, greatest_depth, colour_max, epsilon,
               first_pixel, end_pixel);

}  // namespace oit
