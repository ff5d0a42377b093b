// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.hpp"

namespace viewer {

/// A line of a script.
struct ScriptCommand {
    std::size_t line = 0;  ///< from 1
    std::string name;
    std::vector<std::string> words = {};  ///< after the name

    /// A word as a number. Throws InputError, which names the line, where there is no such word, or
    /// it is no number.
    [[nodiscard]] double number(std::size_t word) const;
    /// A word. Throws likewise.
    [[nodiscard]] const std::string& text(std::size_t word) const;
    [[noreturn]] void refuse(const std::string& why) const;
};

/// Reads the commands of a text, one a line. Lines that are empty or start with # are none. Throws
/// InputError for a command that does not exist.
[[nodiscard]] std::vector<ScriptCommand> read_script(std::string_view text);

/// The commands, for the help.
[[nodiscard]] std::string script_help();

/// Runs a command that changes the model alone. False where it is for the window. Throws InputError
/// where its words cannot be used.
bool run_on_model(const ScriptCommand& command, Model& model);

}  // namespace viewer
