// SPDX-License-Identifier: MIT
#include "model/script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "input_error.hpp"

namespace viewer {
namespace {

struct KnownCommand {
    std::string_view name, words, summary;
};

constexpr std::array<KnownCommand, 21> known_commands{{
    {"orbit", "AZIMUTH ELEVATION", "turn the camera by these degrees"},
    {"zoom", "FACTOR", "move the camera nearer by this factor"},
    {"key", "NAME", "press a key: space, h, s, t, tab, r, left, +, escape ..."},
    {"set", "[right] OPTION VALUE", "set an option of the program, such as: set method kbuffer:4"},
    {"show", "PROGRAM SCENE...", "show a scene of oit, shadows or motion-shadows"},
    {"time", "SECONDS", "set the time of a scene that moves"},
    {"split", "PART|off", "split the view at this part of its width"},
    {"heat", "on|off", "show list lengths in place of the picture"},
    {"turn", "on|off", "let the camera turn"},
    {"play", "on|off", "let time pass"},
    {"click", "X Y", "show the list of a pixel of the picture"},
    {"drag", "X Y X Y", "drag the mouse between two pixels of the picture"},
    {"scroll", "STEPS", "turn the wheel of the mouse"},
    {"resize", "WIDTH HEIGHT", "resize the picture by resizing the window"},
    {"frames", "N", "wait until N more frames are drawn"},
    {"save", "FILE", "save the picture, as the program that draws it offline does"},
    {"screenshot", "FILE", "save the window as PNG"},
    {"print", "command|error|list|fps|status", "print a line"},
    {"copy", "", "copy the command line to the clipboard, and print it"},
    {"wait", "SECONDS", "wait"},
    {"quit", "[now]", "end the program; now: also while a frame is drawn"},
}};

bool is_on(const ScriptCommand& command) {
    const std::string& word = command.text(0);
    if (word != "on" && word != "off") command.refuse("expected on or off");
    return word == "on";
}

void run_set(const ScriptCommand& command, Model& model) {
    const std::size_t side = command.text(0) == "right" ? 1 : 0;
    const std::string& name = command.text(side);
    const Control* control = find_control(model.program().controls, "--" + name);
    if (control == nullptr) command.refuse("there is no option '" + name + "'");
    model.set(*control, command.text(side + 1), side);
}

void run_show(const ScriptCommand& command, Model& model) {
    const Program* program = find_program(command.text(0));
    if (program == nullptr) command.refuse("there is no program '" + command.text(0) + "'");
    (void)command.text(1);
    model.show(*program, {command.words.begin() + 1, command.words.end()});
}

void run_split(const ScriptCommand& command, Model& model) {
    model.is_split = command.text(0) != "off";
    if (model.is_split) model.split_at = std::clamp(command.number(0), 0.0, 1.0);
}

}  // namespace

void ScriptCommand::refuse(const std::string& why) const {
    throw support::InputError("script line " + std::to_string(line) + ", " + name + ": " + why);
}

const std::string& ScriptCommand::text(std::size_t word) const {
    if (word >= words.size()) refuse("a word is missing");
    return words[word];
}

double ScriptCommand::number(std::size_t word) const {
    const std::string& digits = text(word);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
        refuse("'" + digits + "' is no number");
    return value;
}

std::vector<ScriptCommand> read_script(std::string_view text) {
    std::vector<ScriptCommand> commands;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream words(line);
        ScriptCommand command{.line = number, .name = {}};
        if (!(words >> command.name) || command.name.starts_with('#')) continue;
        for (std::string word; words >> word;) command.words.push_back(word);
        if (std::ranges::find(known_commands, command.name, &KnownCommand::name) ==
            known_commands.end())
            command.refuse("there is no such command (see --help)");
        commands.push_back(std::move(command));
    }
    return commands;
}

std::string script_help() {
    std::string help;
    for (const auto& [name, words, summary] : known_commands) {
        std::string line = "  " + std::string(name) + " " + std::string(words);
        line.resize(std::max<std::size_t>(line.size() + 1, 36), ' ');
        help += line + std::string(summary) + "\n";
    }
    return help;
}

bool run_on_model(const ScriptCommand& command, Model& model) {
    const std::string& name = command.name;
    if (name == "orbit")
        model.orbit_by(command.number(0), command.number(1));
    else if (name == "zoom")
        model.zoom_by(command.number(0));
    else if (name == "set")
        run_set(command, model);
    else if (name == "show")
        run_show(command, model);
    else if (name == "time")
        model.set_time(command.number(0));
    else if (name == "split")
        run_split(command, model);
    else if (name == "heat")
        model.heat_map = is_on(command);
    else if (name == "turn")
        model.turns = is_on(command);
    else if (name == "play")
        model.plays = is_on(command);
    else if (name == "click")
        model.click({static_cast<int>(command.number(0)), static_cast<int>(command.number(1))});
    else if (name == "drag")
        model.drag_by(command.number(2) - command.number(0), command.number(3) - command.number(1));
    else if (name == "scroll")
        model.scroll(command.number(0));
    else if (name == "key") {
        if (!model.press(command.text(0))) command.refuse("the key has no meaning");
    } else
        return false;
    return true;
}

}  // namespace viewer
