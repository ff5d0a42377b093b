// SPDX-License-Identifier: MIT
#pragma once

#include "model/model.hpp"
#include "window/shown.hpp"

namespace viewer {

/// Draws the pictures in a part of the window that begins at `left`, and takes the mouse there:
/// dragging turns the camera or moves the border of a split view, a click chooses a pixel, the
/// wheel zooms.
void show_picture_area(Model& model, const Shown& shown, float left);

/// The size in pixels of a picture that fills the area.
[[nodiscard]] std::pair<int, int> picture_area_size(std::pair<int, int> window_size, float left,
                                                    float pixels_per_unit);

}  // namespace viewer
