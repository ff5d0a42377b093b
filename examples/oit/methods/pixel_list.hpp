// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <cellist/cellist.hpp>

#include "frame/fragment_source.hpp"

namespace oit {

/// A transparent fragment, before it is packed into a node.
struct PixelFragment {
    cl_float depth;
    cl_float colour[3];  ///< linear, not multiplied by alpha
    cl_float alpha;
    cl_uint blend;     ///< Blend; 6 where a surface is left
    cl_uint coverage;  ///< a bit for each sample
};
CELLIST_STRUCT(PixelFragment, depth, colour, alpha, blend, coverage);

/// The transparent fragments of one pixel of all eyes, nearest first, whatever the method stores:
/// in one pass that keeps no others. The source must have drawn its frame. Blocks.
[[nodiscard]] std::vector<PixelFragment> pixel_list(FragmentSource& source, std::size_t pixel);

}  // namespace oit
