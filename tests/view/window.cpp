// SPDX-License-Identifier: MIT
// The window, driven by scripts under Xvfb with Mesa's software OpenGL.
#include <cstdlib>

#include <stb_image.h>

#include "oit/support/files.hpp"
#include "oit/support/program.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"
#include "support/skip.hpp"
#include "view/support/display.hpp"

namespace cellist::test {
namespace {

// What stands before a program that opens a window; empty where there is no Xvfb.
const std::string& on_a_display() {
    static const Display display;
    static const std::string environment =
        display.name().empty()
            ? std::string()
            : "LIBGL_ALWAYS_SOFTWARE=1 WAYLAND_DISPLAY= DISPLAY=" + display.name();
    return environment;
}

// Why no window can be opened here; empty where it can.
const std::string& no_window() {
    static const std::string reason = [] {
        if (on_a_display().empty()) return std::string("there is no Xvfb (xvfb)");
        const Program program(CELLIST_VIEW_PROGRAM);
        (void)program.folder().write("s.txt", "quit now\n");
        const ProgramResult result = program.run("smoke --script s.txt", on_a_display());
        return result.exit_code == 0 ? std::string() : "no window: " + result.error;
    }();
    return reason;
}

ProgramResult run_script(const Program& program, const std::string& arguments,
                         const std::string& script) {
    (void)program.folder().write("s.txt", script);
    return program.run(arguments + " --script s.txt", on_a_display());
}

struct Bytes {
    int width = 0, height = 0;
    std::vector<unsigned char> values;  // red, green and blue of each pixel
};

Bytes read_png(const std::filesystem::path& path) {
    Bytes image;
    int channels = 0;
    unsigned char* values = stbi_load(path.c_str(), &image.width, &image.height, &channels, 3);
    REQUIRE(values != nullptr);
    image.values.assign(values, values + std::ptrdiff_t{3} * image.width * image.height);
    stbi_image_free(values);
    return image;
}

int largest_difference(const Bytes& a, const Bytes& b) {
    REQUIRE(a.values.size() == b.values.size());
    int largest = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
    return largest;
}

TEST_CASE("the window shows the picture that the program draws offline") {
    if (!no_window().empty()) CELLIST_SKIP(no_window());
    const Program program(CELLIST_VIEW_PROGRAM);
    const ProgramResult shown =
        run_script(program, "knot.obj --size 320x200",
                   "key tab\nresize 320 200\norbit 30 10\nzoom 1.5\nset method kbuffer:8\n"
                   "screenshot window.png\nsave picture.png\ncopy\nquit\n");
    INFO(shown.error << shown.out);
    REQUIRE(shown.exit_code == 0);
    const std::string command = shown.out.substr(shown.out.find("cellist-oit "));
    const std::string arguments = command.substr(12, command.find('\n') - 12);
    CHECK(arguments == "knot.obj --method kbuffer:8 --size 320x200 --view 55,18 --zoom 1.5");
    const Program offline(CELLIST_OIT_PROGRAM);
    REQUIRE(offline.run(arguments + " --frames 1 --out offline.png").exit_code == 0);
    CHECK(read_file(program.folder() / "picture.png") ==
          read_file(offline.folder() / "offline.png"));
    const Bytes window = read_png(program.folder() / "window.png");
    CHECK(window.width == 320);
    CHECK(window.height == 200);
    // The window rounds where the file dithers.
    CHECK(largest_difference(window, read_png(offline.folder() / "offline.png")) <= 1);
}

TEST_CASE("the window outlives errors, changes of size and program, and closes at any time") {
    if (!no_window().empty()) CELLIST_SKIP(no_window());
    const Program program(CELLIST_VIEW_PROGRAM);
    const ProgramResult result =
        run_script(program, "knot.obj --size 160x120",
                   "set samples exact\nset layers 4\nprint error\nset layers all\nprint error\n"
                   "click 80 60\nprint list\nsplit 0.3\nset right method weighted\nset samples 1\n"
                   "screenshot split.png\nheat on\nscreenshot heat.png\nheat off\nresize 200 100\n"
                   "show motion-shadows cubes\nset samples 1\nscreenshot motion.png\n"
                   "show shadows swarm\nset samples 2\nplay on\nframes 3\nplay off\nkey q\n");
    INFO(result.error << result.out);
    CHECK(result.exit_code == 0);
    CHECK(contains(result.out, "error: --samples exact blends all"));
    CHECK(contains(result.out, "error: \n"));
    CHECK(contains(result.out, "list: "));
    CHECK_FALSE(contains(result.out, "list: none"));
    for (const char* name : {"split.png", "heat.png", "motion.png"})
        CHECK(read_png(program.folder() / name).width > 300);
    CHECK(run_script(program, "knot.obj --size 640x480", "wait 0.1\nquit now\n").exit_code == 0);
}

TEST_CASE("a script that cannot be used is an error in one line") {
    if (!no_window().empty()) CELLIST_SKIP(no_window());
    const Program program(CELLIST_VIEW_PROGRAM);
    (void)program.folder().write("s.txt", "orbit 3\n");
    program.require_refused("smoke --script s.txt", "script line 1, orbit", on_a_display());
    program.require_refused("smoke --script nosuch.txt", "nosuch.txt");
    program.require_refused("smoke --josn a", "no option of the viewer");
    program.require_refused("smoke", "no display", "env -u DISPLAY -u WAYLAND_DISPLAY");
}

}  // namespace
}  // namespace cellist::test
