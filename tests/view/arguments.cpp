// SPDX-License-Identifier: MIT
// Command lines of the programs: read, changed and written.
#include "program/arguments.hpp"

#include <algorithm>

#include "input_error.hpp"
#include "program/program.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using viewer::Arguments;

const viewer::Program& oit_program() { return *viewer::find_program("oit"); }

Arguments read_words(const std::vector<std::string>& words) {
    return viewer::read_arguments(words, oit_program().controls);
}

TEST_CASE("words become a scene and options, and the same words again") {
    const Arguments arguments = read_words(
        {"a.ply:0.5", "b.ply", "--view=-30,20", "--opaque-floor", "--method", "kbuffer:4"});
    CHECK(arguments.scene == std::vector<std::string>{"a.ply:0.5", "b.ply"});
    CHECK(arguments.get("--view") == "-30,20");
    CHECK(arguments.has("--opaque-floor"));
    CHECK(arguments.words("p") == std::vector<std::string>{"p", "a.ply:0.5", "b.ply", "--method",
                                                           "kbuffer:4", "--opaque-floor", "--view",
                                                           "-30,20"});
}

TEST_CASE("an option that is no option of the viewer is refused, with the one that is meant") {
    const auto message = [](const std::vector<std::string>& words) {
        return std::string(error_of<support::InputError>([&] { (void)read_words(words); }).what());
    };
    CHECK(contains(message({"--methd", "linked"}), "--method"));
    CHECK(contains(message({"--json", "a.json"}), "--json is no option"));
    CHECK(contains(message({"--method"}), "--method needs a value"));
}

TEST_CASE("a command line is quoted for a shell where it needs to be") {
    Arguments arguments = read_words({"my dragon's.ply", "--alpha", "0.5"});
    CHECK(arguments.command_line("cellist-oit") == "cellist-oit 'my dragon'\\''s.ply' --alpha 0.5");
}

TEST_CASE("options without effect beside others are left out") {
    const auto left = [](const std::vector<std::string>& words) {
        return viewer::effective(read_words(words), oit_program().controls).command_line("p");
    };
    CHECK(left({"smoke", "--budget", "40dB", "--method", "linked", "--layers", "8"}) ==
          "p smoke --budget 40dB");
    const std::vector<viewer::Control>& motion = viewer::find_program("motion-shadows")->controls;
    const std::vector<std::string> words{"cubes", "--times", "64"};
    CHECK(viewer::effective(viewer::read_arguments(words, motion), motion).command_line("p") ==
          "p cubes");
}

TEST_CASE("the default of a control is one of its choices") {
    for (const viewer::Program& program : viewer::programs())
        for (const viewer::Control& control : program.controls) {
            INFO(program.name << " " << control.option);
            CHECK(control.option.starts_with("--"));
            const bool has_default =
                control.kind != viewer::Control::Kind::choice || control.usual == "none" ||
                std::ranges::find(control.choices, control.usual) != control.choices.end();
            CHECK(has_default);
        }
}

}  // namespace
}  // namespace cellist::test
