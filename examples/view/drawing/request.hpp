// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "program/program.hpp"

namespace viewer {

/// A pixel of the picture, of all eyes side by side.
struct Pixel {
    int x = 0, y = 0;
    [[nodiscard]] bool operator==(const Pixel&) const = default;
};

/// What the window is to show.
struct Request {
    const Program* program = nullptr;
    std::vector<Arguments> sides = {};  ///< one, or left and right
    bool heat_map = false;              ///< in place of the pictures
    std::optional<Pixel> pixel = {};    ///< whose list is shown

    [[nodiscard]] bool operator==(const Request&) const = default;
};

/// A drawn side of the window.
struct DrawnSide {
    std::string error = {};          ///< why there is no picture
    std::vector<cl_uint> rgba = {};  ///< row by row from the top, 8 bits a channel, red lowest
    int width = 0, height = 0;       ///< of all eyes side by side
    PictureInfo info = {};
    std::optional<unsigned> longest_list = {};  ///< what the brightest colour of a heat map means
    std::string heat_caption = {};
    std::optional<std::vector<ListEntry>> list = {};  ///< of Request::pixel
};

/// The answer to a request.
struct Drawn {
    Request request = {};
    std::vector<DrawnSide> sides = {};
};

}  // namespace viewer
