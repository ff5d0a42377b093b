#pragma once

#include <cellist/cellist.hpp>

namespace oit {

/// What a transparent surface leaves in a pixel: its depth along the viewing direction and its
/// linear colour, not yet multiplied by its opacity.
struct Fragment {
    cl_float depth;
    cl_float red;
    cl_float green;
    cl_float blue;
};
CELLIST_STRUCT(Fragment, depth, red, green, blue);

}  // namespace oit
