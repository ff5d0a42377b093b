// SPDX-License-Identifier: MIT
// Shows what cellist-oit, cellist-shadows and cellist-motion-shadows draw, in a window.
#include <algorithm>
#include <charconv>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "input_error.hpp"
#include "model/script.hpp"
#include "read_file.hpp"
#include "window/app.hpp"

namespace {

std::string help() {
    std::string text =
        "Shows pictures of a program in a window, and changes their settings.\n"
        "Usage: cellist-view [PROGRAM] [SCENE...] [OPTIONS of the program] [--script FILE]\n\n"
        "Programs and scenes:\n";
    for (const viewer::Program& program : viewer::programs()) {
        text += "  " + program.name + ": a mesh file";
        for (const std::string& scene : program.scenes) text += ", " + scene;
        text += "\n";
    }
    text += "The default program is " + viewer::programs().front().name +
            ". Options are those of the program that draws the same picture.\n";
    for (const viewer::Program& program : viewer::programs()) {
        text += "\nOptions of " + program.command + " that the viewer takes:\n";
        for (const viewer::Control& control : program.controls) {
            std::string line = "  " + control.option + " ";
            line.resize(std::max<std::size_t>(line.size(), 24), ' ');
            text += line + control.hint + "\n";
        }
    }
    return text +
           "\n--size WxH, or --width and --height, is the size of the picture in the beginning; it "
           "follows the window.\n\n"
           "Keys: space play, t turn, h heat map, s split, arrows and +/- camera, r reset it,\n"
           "      tab panel, p save the picture, c copy the command line, q quit\n\n"
           "Commands of a script, one a line:\n" +
           viewer::script_help();
}

// Takes --script and its file out of the words.
std::optional<std::string> take_script(std::vector<std::string>& words) {
    const auto option = std::ranges::find(words, "--script");
    if (option == words.end()) return {};
    if (option + 1 == words.end()) throw support::InputError("--script needs a file (see --help)");
    const std::string path = *(option + 1);
    words.erase(option, option + 2);
    return path;
}

// The size that the arguments ask for. They lose it: the picture has the size of the window.
std::pair<int, int> take_size(viewer::Arguments& arguments) {
    const auto number = [](const std::string& text, int otherwise) {
        int value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        return error == std::errc() && value > 0 ? value : otherwise;
    };
    const std::string size = arguments.get("--size", "1280x720");
    const std::size_t x = std::min(size.find('x'), size.size() - 1);
    return {number(arguments.get("--width", size.substr(0, x)), 1280),
            number(arguments.get("--height", size.substr(x + 1)), 720)};
}

void run(std::vector<std::string> words) {
    const std::optional<std::string> script_path = take_script(words);
    std::vector<viewer::ScriptCommand> script;
    if (script_path)
        script = viewer::read_script(support::read_file("script", *script_path, 1 << 20));
    const viewer::Program* program = words.empty() ? nullptr : viewer::find_program(words.front());
    if (program != nullptr)
        words.erase(words.begin());
    else
        program = &viewer::programs().front();
    viewer::Arguments arguments = viewer::read_arguments(words, program->controls);
    const std::pair<int, int> size = take_size(arguments);
    viewer::App app(viewer::Model(*program, std::move(arguments)), size, std::move(script));
    app.run();
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-view", [&] {
        std::vector<std::string> words(arguments + 1, arguments + count);
        const auto has = [&](const char* word) {
            return std::ranges::find(words, word) != words.end();
        };
        if (has("--help") || has("-h"))
            std::cout << help();
        else if (has("--version"))
            std::cout << "cellist-view " << support::version() << '\n';
        else
            run(std::move(words));
        return true;
    });
}
