// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/control.hpp"
#include "program/instrument.hpp"

namespace viewer {

/// A program whose pictures the viewer shows.
struct Program {
    std::string name;     ///< on the viewer's command line
    std::string command;  ///< that draws the same picture offline
    std::string title;
    std::vector<std::string> scenes;  ///< that need no file
    std::vector<Control> controls;
    std::string time_option = {};                 ///< empty where no scene has a time
    std::vector<std::string> scene_options = {};  ///< do not outlive their scene
    /// Sets the size of the picture in pixels.
    void (*set_size)(Arguments&, int width, int height);
    /// Refers to the studio, which must outlive the instrument.
    std::unique_ptr<Instrument> (*make)(const Studio&);
};

[[nodiscard]] Program make_oit_program();
[[nodiscard]] Program make_shadows_program();
[[nodiscard]] Program make_motion_program();

/// All programs; the first is the default.
[[nodiscard]] std::span<const Program> programs();

/// Null where there is none of this name.
[[nodiscard]] const Program* find_program(std::string_view name);

/// For programs with --width and --height.
void set_width_and_height(Arguments& arguments, int width, int height);

/// The controls that all programs have: --view, --zoom, --device, and --time where `time` is true.
void add_common_controls(std::vector<Control>& controls);

}  // namespace viewer
