// SPDX-License-Identifier: MIT
#pragma once

#include "model/model.hpp"

namespace viewer {

/// The choice of program and scene.
void show_scene(Model& model);

/// The options of the program; in a split view, those of both sides.
void show_controls(Model& model);

}  // namespace viewer
