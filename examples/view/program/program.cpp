// SPDX-License-Identifier: MIT
#include "program/program.hpp"

#include <array>

namespace viewer {

std::span<const Program> programs() {
    static const std::array all{make_oit_program(), make_shadows_program(), make_motion_program()};
    return all;
}

const Program* find_program(std::string_view name) {
    for (const Program& program : programs())
        if (program.name == name) return &program;
    return nullptr;
}

void set_width_and_height(Arguments& arguments, int width, int height) {
    arguments.set("--width", std::to_string(width));
    arguments.set("--height", std::to_string(height));
}

void add_common_controls(std::vector<Control>& controls) {
    controls.push_back({.option = "--view"});
    controls.push_back({.option = "--zoom"});
    controls.push_back({.option = "--device"});
}

}  // namespace viewer
