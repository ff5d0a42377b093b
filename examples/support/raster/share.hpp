// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace raster {

/// Which triangles are drawn, if several processes share them: one of `count` parts of equal size.
struct Share {
    std::size_t index = 0;
    std::size_t count = 1;
};

}  // namespace raster
