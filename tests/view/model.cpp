// SPDX-License-Identifier: MIT
// What inputs change: settings of both sides, camera, time, and what the keys do.
#include "model/model.hpp"

#include "support/catch.hpp"

namespace cellist::test {
namespace {

using viewer::Model;

Model model_of(const char* program, const std::vector<std::string>& words) {
    const viewer::Program& found = *viewer::find_program(program);
    return {found, viewer::read_arguments(words, found.controls)};
}

const viewer::Control& control_of(const Model& model, const char* option) {
    return *viewer::find_control(model.program().controls, option);
}

// As if the request had been drawn.
void answer(Model& model, const viewer::PictureInfo& info, double now_s = 0) {
    viewer::Drawn drawn{.request = model.request()};
    for (std::size_t i = 0; i < drawn.request.sides.size(); ++i)
        drawn.sides.push_back({.info = info});
    model.take(drawn, now_s);
}

TEST_CASE("the default of an option leaves it out, and the right side keeps its own") {
    Model model = model_of("oit", {"smoke", "--layers", "8"});
    const viewer::Control& method = control_of(model, "--method");
    model.set(method, "kbuffer:4");
    CHECK(model.command_line() == "cellist-oit smoke --layers 8 --method kbuffer:4");
    model.set(method, "linked", 1);
    CHECK(model.value(method, 0) == "kbuffer:4");
    CHECK(model.value(method, 1) == "linked");
    CHECK(model.command_line(1) == "cellist-oit smoke --layers 8");
    model.set(method, "linked");
    CHECK(model.command_line() == "cellist-oit smoke --layers 8");
    model.set(control_of(model, "--opaque-floor"), "on");
    CHECK(model.command_line() == "cellist-oit smoke --layers 8 --opaque-floor");
}

TEST_CASE("a split view asks for two pictures") {
    Model model = model_of("oit", {"smoke"});
    CHECK(model.request().sides.size() == 1);
    model.set(control_of(model, "--method"), "weighted", 1);
    CHECK(model.request().sides.size() == 1);
    CHECK(model.press("s"));
    REQUIRE(model.request().sides.size() == 2);
    CHECK(model.request().sides[1].get("--method") == "weighted");
}

TEST_CASE("the camera turns from where the last picture had it, and stays off the poles") {
    Model model = model_of("shadows", {"room"});
    model.orbit_by(10, 0);
    CHECK(model.command_line() == "cellist-shadows room");  // nothing is known of the camera
    answer(model, {.orbit = {.azimuth_degrees = 5, .elevation_degrees = 80}});
    model.orbit_by(10, 20);
    CHECK(model.arguments().get("--view") == "15,89");
    model.drag_by(-100, 0);
    CHECK(model.arguments().get("--view") == "55,89");
    model.orbit_by(-240, 0);
    CHECK(model.arguments().get("--view") == "175,89");
    model.scroll(1);
    CHECK(model.arguments().get("--zoom") == "1.1");
    CHECK(model.press("r"));
    CHECK(model.command_line() == "cellist-shadows room");
}

TEST_CASE("time passes where the scene moves, and only there") {
    Model model = model_of("oit", {"gearworks"});
    CHECK(model.press("space"));
    CHECK_FALSE(model.is_animated());
    answer(model, {.moves = true});
    CHECK(model.press("space"));
    CHECK(model.is_animated());
    model.advance(0.25);
    model.advance(0.25);
    CHECK(model.arguments().get("--time") == "0.5");
    model.show(*viewer::find_program("oit"), {"smoke"});
    CHECK_FALSE(model.is_animated());
    CHECK(model.command_line() == "cellist-oit smoke");
}

TEST_CASE("another program keeps the options of the first for later") {
    Model model = model_of("oit", {"a.ply", "--samples", "4", "--alpha", "0.5"});
    model.set_picture_size(640, 360);
    model.show(*viewer::find_program("motion-shadows"), {"fan"});
    CHECK(model.command_line() == "cellist-motion-shadows fan --height 360 --width 640");
    CHECK(model.files() == std::vector<std::vector<std::string>>{{"a.ply"}});
    model.show(*viewer::find_program("oit"), {"smoke"});
    CHECK(model.command_line() == "cellist-oit smoke --samples 4 --size 640x360");
}

TEST_CASE("a click chooses a pixel, and a second one on it none") {
    Model model = model_of("oit", {"smoke"});
    model.click({3, 4});
    CHECK(model.request().pixel == viewer::Pixel{3, 4});
    model.click({5, 4});
    CHECK(model.request().pixel == viewer::Pixel{5, 4});
    model.click({5, 4});
    CHECK_FALSE(model.request().pixel);
    CHECK_FALSE(model.press("F12"));
}

TEST_CASE("what the budget decides is idle") {
    Model model = model_of("oit", {"smoke"});
    CHECK_FALSE(model.is_idle(control_of(model, "--method")));
    model.set(control_of(model, "--budget"), "40dB");
    CHECK(model.is_idle(control_of(model, "--method")));
    CHECK_FALSE(model.is_idle(control_of(model, "--samples")));
}

TEST_CASE("frames per second leave pauses out") {
    viewer::FrameTimes times;
    CHECK_FALSE(times.frames_per_second());
    for (const double now : {0.0, 10.0, 10.1, 10.2, 10.3}) times.add(5, now);
    CHECK(times.frames_per_second().value_or(0) == Approx(10));
    for (int i = 0; i < 500; ++i) times.add(1, 20 + i);
    CHECK(times.milliseconds().size() == viewer::FrameTimes::most);
}

}  // namespace
}  // namespace cellist::test
