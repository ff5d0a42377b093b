// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/arguments.hpp"

namespace viewer {

/// An option of a program that the viewer takes.
struct Control {
    enum class Kind {
        choice,  ///< one of some texts
        number,  ///< from `least` to `most`
        text,    ///< any text
        flag,    ///< given or not
    };
    Kind kind = Kind::text;
    std::string option = {};
    std::string label = {};  ///< in the panel; empty: not there
    std::string usual = {};  ///< what the program takes where the option is not given
    std::string hint = {};
    std::vector<std::string> choices = {};
    double least = 0, most = 1;
    /// In a split view, the right side may have another value.
    bool splits = false;
    /// Other options that have no effect while this one is given, and are left out then.
    std::vector<std::string> replaces = {};
    /// An option and the text without which this one has no effect, and is left out.
    Arguments::Option needs = {};
};

/// The control of an option, or null.
[[nodiscard]] inline const Control* find_control(const std::vector<Control>& controls,
                                                 std::string_view option) {
    for (const Control& control : controls)
        if (control.option == option) return &control;
    return nullptr;
}

/// Reads the arguments that follow a program's name. Throws InputError where an option is not one
/// of these, or lacks its text.
[[nodiscard]] Arguments read_arguments(std::span<const std::string> words,
                                       const std::vector<Control>& controls);

/// Without the options that have no effect beside the others.
[[nodiscard]] Arguments effective(const Arguments& arguments, const std::vector<Control>& controls);

}  // namespace viewer
