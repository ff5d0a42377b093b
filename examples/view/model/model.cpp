// SPDX-License-Identifier: MIT
#include "model/model.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "camera_options.hpp"
#include "files.hpp"
#include "input_error.hpp"
#include "number_text.hpp"

namespace viewer {
namespace {

constexpr double turn_degrees_per_second = 30;
constexpr double zoom_min = 0.1, zoom_max = 50;

double number_or(const std::string& text, double otherwise) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && std::isfinite(value) ? value : otherwise;
}

// Angles and times need no more digits than people can see.
double rounded(double value, double step) { return std::round(value / step) * step; }

}  // namespace

Model::Model(const Program& program, Arguments arguments)
    : program_(&program), arguments_(std::move(arguments)) {
    const auto& names = program.scenes;
    if (arguments_.scene.empty()) arguments_.scene = {names.front()};
    if (std::ranges::find(names, arguments_.scene.front()) == names.end())
        files_.push_back(arguments_.scene);
}

std::string Model::scene_name(const std::vector<std::string>& scene) {
    std::string name;
    for (const std::string& part : scene)
        name +=
            (name.empty() ? "" : " + ") + support::text_of(std::filesystem::path(part).filename());
    return name;
}

void Model::show(const Program& program, std::vector<std::string> scene) {
    if (&program == program_ && scene == arguments_.scene) return;
    if (&program != program_) {
        others_[program_->name] = std::move(arguments_);
        arguments_ = std::exchange(others_[program.name], {});
        right_ = {};
        program_ = &program;
    }
    arguments_.scene = std::move(scene);
    for (const std::string& option : program.scene_options) arguments_.remove(option);
    pixel.reset();
    plays = moves_ = has_orbit_ = false;
    for (FrameTimes& times : times_) times.clear();
    if (width_ > 0) program.set_size(arguments_, width_, height_);
}

std::string Model::value(const Control& control, std::size_t side) const {
    return arguments_of(side).get(control.option, control.usual);
}

void Model::set(const Control& control, const std::string& text, std::size_t side) {
    const bool is_flag = control.kind == Control::Kind::flag;
    const bool is_usual = text.empty() || (is_flag ? text == "off" : text == control.usual);
    if (side == 1 && value(control, 0) == text)
        right_.remove(control.option);
    else if (side == 1)
        right_.set(control.option, text);
    else if (is_usual)
        arguments_.remove(control.option);
    else
        arguments_.set(control.option, is_flag ? "" : text);
    for (FrameTimes& times : times_) times.clear();
}

bool Model::is_idle(const Control& control, std::size_t side) const {
    Arguments all = arguments_of(side);
    all.set(control.option, "-");
    return !effective(all, program_->controls).has(control.option);
}

void Model::set_picture_size(int width, int height) {
    width_ = width;
    height_ = height;
    program_->set_size(arguments_, width, height);
    pixel.reset();
    for (FrameTimes& times : times_) times.clear();
}

Arguments Model::arguments_of(std::size_t side) const {
    Arguments all = arguments_;
    if (side == 0) return all;
    for (const auto& [option, text] : right_.options()) {
        const Control* control = find_control(program_->controls, option);
        if (control != nullptr && text == control->usual)
            all.remove(option);
        else
            all.set(option, text);
    }
    return all;
}

std::string Model::command_line(std::size_t side) const {
    return effective(arguments_of(side), program_->controls).command_line(program_->command);
}

Request Model::request() const {
    Request request{
        .program = program_, .sides = {arguments_}, .heat_map = heat_map, .pixel = pixel};
    if (is_split) request.sides.push_back(arguments_of(1));
    return request;
}

void Model::orbit_by(double azimuth_degrees, double elevation_degrees) {
    if (!has_orbit_) return;
    support::Orbit orbit = infos_[0].orbit;
    try {
        if (arguments_.has("--view")) orbit = support::read_view(arguments_.get("--view"));
    } catch (const support::InputError&) {
        // The text of --view is none; the last picture still has a camera.
    }
    orbit.azimuth_degrees =
        rounded(std::remainder(orbit.azimuth_degrees + azimuth_degrees, 360.0), 0.01);
    orbit.elevation_degrees =
        rounded(std::clamp(orbit.elevation_degrees + elevation_degrees, -89.0, 89.0), 0.01);
    arguments_.set("--view", support::view_text(orbit));
}

void Model::zoom_by(double factor) {
    const double zoom = number_or(arguments_.get("--zoom"), 1) * factor;
    arguments_.set("--zoom",
                   support::shortest(rounded(std::clamp(zoom, zoom_min, zoom_max), 0.001)));
}

void Model::reset_camera() {
    arguments_.remove("--view");
    arguments_.remove("--zoom");
}

void Model::drag_by(double x, double y) {
    constexpr double degrees_per_unit = 0.4;
    orbit_by(-degrees_per_unit * x, degrees_per_unit * y);
}

void Model::scroll(double steps) { zoom_by(std::pow(1.1, steps)); }

void Model::click(const Pixel& place) {
    if (pixel == place || place.x < 0 || place.y < 0)
        pixel.reset();
    else
        pixel = place;
}

double Model::time() const { return number_or(arguments_.get(program_->time_option), 0); }

void Model::set_time(double seconds) {
    if (program_->time_option.empty()) return;
    if (seconds == 0)
        arguments_.remove(program_->time_option);
    else
        arguments_.set(program_->time_option, support::shortest(rounded(seconds, 0.001)));
}

void Model::advance(double seconds) {
    if (plays && moves_) set_time(time() + seconds);
    if (turns) orbit_by(seconds * turn_degrees_per_second, 0);
}

bool Model::press(std::string_view key) {
    constexpr double step_degrees = 5, zoom_step = 1.1;
    if (key == "space")
        plays = !plays && moves_;
    else if (key == "t")
        turns = !turns;
    else if (key == "h")
        heat_map = !heat_map;
    else if (key == "s")
        is_split = !is_split;
    else if (key == "tab")
        shows_panel = !shows_panel;
    else if (key == "r")
        reset_camera();
    else if (key == "left")
        orbit_by(-step_degrees, 0);
    else if (key == "right")
        orbit_by(step_degrees, 0);
    else if (key == "up")
        orbit_by(0, step_degrees);
    else if (key == "down")
        orbit_by(0, -step_degrees);
    else if (key == "+")
        zoom_by(zoom_step);
    else if (key == "-")
        zoom_by(1 / zoom_step);
    else if (key == "escape" && pixel)
        pixel.reset();
    else if (key == "c")
        wishes.copy = true;
    else if (key == "p")
        wishes.save = true;
    else if (key == "q")
        wishes.quit = true;
    else
        return false;
    return true;
}

void Model::take(const Drawn& drawn, double now_s) {
    for (std::size_t side = 0; side < drawn.sides.size(); ++side) {
        const DrawnSide& answer = drawn.sides[side];
        if (!answer.error.empty()) continue;
        infos_[side] = answer.info;
        times_[side].add(answer.info.frame_ms, now_s);
        if (side == 0 && drawn.request.program == program_) {
            has_orbit_ = true;
            moves_ = answer.info.moves;
        }
    }
}

}  // namespace viewer
