// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "frame/fragment_source.hpp"

namespace oit {

/// The number of transparent fragments in each pixel, eye by eye, row by row from the top: in one
/// pass that only counts. The source must have drawn its frame, so that the pass has room. Blocks.
[[nodiscard]] std::vector<cl_uint> count_fragments(FragmentSource& source);

}  // namespace oit
