// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace oit {

/// Returns a list method (linked, counted or fixed) with its lists distributed over the ranks of
/// MPI_COMM_WORLD. Each rank draws its Frame::share of the triangles and owns some rows of pixels.
/// Fragments go to the rank that owns their pixel, which blends them. The first rank gets the whole
/// image, the same to the bit for any number of ranks.
///
/// Frames are collective. Throws InputError for other methods.
[[nodiscard]] MethodInfo distributed(const MethodInfo& method);

}  // namespace oit
