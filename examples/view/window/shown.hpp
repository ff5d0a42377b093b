// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "drawing/request.hpp"
#include "window/window.hpp"

namespace viewer {

/// What the window shows of the answers: the last picture of each side, and the last errors.
struct Shown {
    std::array<Texture, 2> textures;
    Request request = {};                 ///< of the last answer
    std::array<DrawnSide, 2> sides = {};  ///< without their pixels
    double progress = -1;                 ///< of long work, or less than 0
    bool is_drawing = false;
};

}  // namespace viewer
