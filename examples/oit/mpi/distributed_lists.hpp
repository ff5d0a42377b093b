// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

namespace oit {

/// A method that keeps its fragments in lists (linked, counted or fixed), over the ranks of
/// MPI_COMM_WORLD. Each rank draws its Frame::share of the triangles and owns some rows of pixels.
/// Fragments go to the rank that owns their pixel, which blends them. The first rank gets the whole
/// image, with the same bits for any number of ranks.
///
/// Frames are collective. Throws InputError for other methods.
[[nodiscard]] MethodInfo distributed(const MethodInfo& method);

}  // namespace oit
