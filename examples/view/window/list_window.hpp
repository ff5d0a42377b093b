// SPDX-License-Identifier: MIT
#pragma once

#include "model/model.hpp"
#include "window/shown.hpp"

namespace viewer {

/// Shows the list of the chosen pixel in the lower right corner of the window.
void show_list(const Model& model, const Shown& shown);

}  // namespace viewer
