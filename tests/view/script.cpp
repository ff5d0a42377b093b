// SPDX-License-Identifier: MIT
// Scripts: which lines are commands, and what is refused.
#include "model/script.hpp"

#include "input_error.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using viewer::read_script;

viewer::Model smoke_model() {
    const viewer::Program& program = *viewer::find_program("oit");
    return {program, viewer::read_arguments(std::vector<std::string>{"smoke"}, program.controls)};
}

TEST_CASE("lines are commands, with their numbers") {
    const auto commands = read_script("# a comment\n\n  orbit 30 -10 \nset method kbuffer\n");
    REQUIRE(commands.size() == 2);
    CHECK(commands[0].line == 3);
    CHECK(commands[0].name == "orbit");
    CHECK(commands[0].number(1) == -10);
    CHECK(commands[1].words == std::vector<std::string>{"method", "kbuffer"});
}

TEST_CASE("a command that does not exist, and words that cannot be used, name the line") {
    const auto error = error_of<support::InputError>([] { (void)read_script("quit\nfly 3\n"); });
    CHECK(contains(error.what(), "script line 2, fly"));
    for (const char* line : {"orbit 30", "orbit 30 up", "set methods linked", "set method",
                             "heat maybe", "show trees a", "show oit", "key F12", "split half"}) {
        INFO(line);
        viewer::Model model = smoke_model();
        CHECK_THROWS_AS(run_on_model(read_script(line).front(), model), support::InputError);
    }
}

TEST_CASE("commands change the model as keys and the mouse do") {
    viewer::Model model = smoke_model();
    for (const viewer::ScriptCommand& command : read_script(
             "set method kbuffer:4\nset right method weighted\nsplit 0.25\nheat on\nclick 3 4\n"
             "zoom 2\nscroll -1\nkey tab\n"))
        CHECK(run_on_model(command, model));
    CHECK(model.command_line() == "cellist-oit smoke --method kbuffer:4 --zoom 1.818");
    CHECK(model.command_line(1) == "cellist-oit smoke --method weighted --zoom 1.818");
    CHECK(model.is_split);
    CHECK(model.split_at == 0.25);
    CHECK(model.heat_map);
    CHECK(model.pixel == viewer::Pixel{3, 4});
    CHECK_FALSE(model.shows_panel);
    CHECK_FALSE(run_on_model(read_script("quit").front(), model));
}

TEST_CASE("the help has all commands") {
    CHECK(viewer::script_help().find("  orbit AZIMUTH ELEVATION") == 0);
    CHECK(viewer::script_help().find("\n  quit ") != std::string::npos);
}

}  // namespace
}  // namespace cellist::test
