// SPDX-License-Identifier: MIT
#pragma once

#include "model/model.hpp"
#include "window/shown.hpp"

namespace viewer {

/// Draws the panel at the left of the window, and changes the model as the user asks.
void show_panel(Model& model, const Shown& shown, float width);

}  // namespace viewer
