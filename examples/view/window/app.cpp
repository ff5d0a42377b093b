// SPDX-License-Identifier: MIT
#include "window/app.hpp"

#include <filesystem>
#include <iostream>
#include <utility>

#include <imgui.h>

#include "files.hpp"
#include "input_error.hpp"
#include "number_text.hpp"
#include "window/list_window.hpp"
#include "window/panel.hpp"
#include "window/picture_area.hpp"

namespace viewer {
namespace {

constexpr float panel_units = 360;
// A size that changes is followed when it has stayed for this time.
constexpr double resize_delay_s = 0.15;

constexpr int most_repeats = 3;

// The first name that no file has: view-1.png, view-2.png, ...
std::string free_name() {
    std::error_code error;
    for (int i = 1;; ++i) {
        std::string name = "view-" + std::to_string(i) + ".png";
        if (!std::filesystem::exists(name, error)) return name;
    }
}

std::string title_of(const Model& model) {
    return model.program().title + ": " + model.scene_name() + " - cellist-view";
}

}  // namespace

App::App(Model model, std::pair<int, int> picture_size, std::vector<ScriptCommand> script)
    : model_(std::move(model)),
      window_(title_of(model_), picture_size.first + static_cast<int>(panel_units),
              picture_size.second),
      script_(std::make_move_iterator(script.begin()), std::make_move_iterator(script.end())),
      thread_(Window::wake) {
    window_.on_key = [this](const std::string& key) { model_.press(key); };
}

void App::run() {
    while (!window_.is_closed()) {
        follow_window_size();
        run_script();
        fulfil_wishes();
        animate();
        send_request();
        window_.wait_events(script_.empty() ? 0.03 : 0.005);
        take_answers();
        if (has_changed()) draw_window();
    }
    window_.hide();
}

void App::animate() {
    const double now = now_s();
    if (!model_.is_animated()) {
        advanced_s_ = now;
    } else if (!thread_.has_waiting()) {
        model_.advance(now - advanced_s_);
        advanced_s_ = now;
    }
}

void App::send_request() {
    if (picture_size_.first == 0) return;
    Request request = model_.request();
    if (sent_ == request) {
        // The first frames of new settings take longer, as buffers find their sizes.
        const bool repeats = script_.empty() && repeats_ < most_repeats;
        if (!is_shown_ || !(repeats || answers_ < frames_wanted_)) return;
        ++repeats_;
    } else {
        repeats_ = 0;
    }
    sent_ = request;
    is_shown_ = false;
    thread_.draw(std::move(request));
}

bool App::has_changed() {
    const double now = now_s();
    if (window_.take_input()) changed_s_ = now;
    // ImGui needs some frames after each input.
    return std::exchange(is_stale_, false) || now < changed_s_ + 0.3;
}

void App::take_answers() {
    for (std::string& message : thread_.take_messages()) {
        std::cout << message << std::endl;
        model_.status = std::move(message);
        is_stale_ = true;
    }
    const bool was_drawing = shown_.is_drawing;
    shown_.is_drawing = !thread_.is_idle();
    if (std::exchange(shown_.progress, thread_.progress()) != shown_.progress) is_stale_ = true;
    if (was_drawing != shown_.is_drawing && !model_.is_animated()) is_stale_ = true;
    std::optional<Drawn> drawn = thread_.take();
    if (!drawn) return;
    is_stale_ = true;
    ++answers_;
    model_.take(*drawn, now_s());
    for (std::size_t i = 0; i < drawn->sides.size(); ++i) {
        DrawnSide& side = drawn->sides[i];
        if (side.error.empty()) {
            shown_.textures[i].upload(side.rgba, side.width, side.height);
            side.rgba = {};
        }
        shown_.sides[i] = std::move(side);
    }
    shown_.request = std::move(drawn->request);
    is_shown_ = sent_ && shown_.request == *sent_;
}

float App::panel_width() const { return model_.shows_panel ? panel_units * window_.scale() : 0; }

std::pair<int, int> App::wanted_picture_size() const {
    const auto [width, height] =
        picture_area_size(window_.size(), panel_width(), window_.pixels_per_unit());
    return {std::max(1, width / model_.eyes()), height};
}

void App::follow_window_size() {
    const std::pair<int, int> wanted = wanted_picture_size();
    const double now = now_s();
    if (wanted != last_size_) size_changed_s_ = now;
    last_size_ = wanted;
    if (wanted == picture_size_) return;
    if (picture_size_.first != 0 && now - size_changed_s_ < resize_delay_s) return;
    picture_size_ = wanted;
    model_.set_picture_size(wanted.first, wanted.second);
}

void App::draw_window() {
    if (std::string title = title_of(model_); title != title_)
        window_.set_title(title_ = std::move(title));
    window_.show(
        [&] {
            const float width = panel_width();
            show_picture_area(model_, shown_, width);
            if (model_.shows_panel) show_panel(model_, shown_, width);
            show_list(model_, shown_);
        },
        [&] {
            if (screenshot_.empty()) return;
            const std::string path = std::exchange(screenshot_, {});
            window_.write_screenshot(path);
            std::cout << "saved " << support::text_of(path) << std::endl;
        });
}

void App::fulfil_wishes() {
    const Model::Wishes wishes = std::exchange(model_.wishes, {});
    if (wishes.quit) window_.close();
    if (wishes.copy) copy_command_line();
    if (wishes.save) save(free_name());
}

void App::save(const std::string& path) {
    thread_.save({.path = path, .split_at = model_.is_split ? model_.split_at : 1});
}

void App::copy_command_line() {
    std::string text = model_.command_line();
    if (model_.is_split) text += "\n" + model_.command_line(1);
    window_.copy(text);
    std::cout << text << std::endl;
    model_.status = "copied the command line";
}

bool App::is_settled() const {
    if (now_s() < script_resumes_s_ || answers_ < frames_wanted_) return false;
    if (picture_size_ != wanted_picture_size() || !screenshot_.empty()) return false;
    if (model_.is_animated()) return true;
    return is_shown_ && sent_ == model_.request() && thread_.is_idle();
}

void App::run_script() {
    while (!script_.empty()) {
        const bool is_now = !script_.front().words.empty() && script_.front().words[0] == "now";
        if (!is_now && !is_settled()) return;
        const ScriptCommand command = std::move(script_.front());
        script_.pop_front();
        run_command(command);
        is_stale_ = true;
        // The next command finds what this one has changed.
        if (sent_ != model_.request() || command.name == "resize") return;
    }
}

void App::run_command(const ScriptCommand& command) {
    const std::string& name = command.name;
    if (run_on_model(command, model_)) return;
    if (name == "resize") {
        const float scale = window_.pixels_per_unit();
        window_.resize(
            static_cast<int>(panel_width() + static_cast<float>(command.number(0)) / scale),
            static_cast<int>(static_cast<float>(command.number(1)) / scale));
    } else if (name == "frames") {
        frames_wanted_ = answers_ + static_cast<std::size_t>(command.number(0));
    } else if (name == "save") {
        save(command.text(0));
    } else if (name == "screenshot") {
        screenshot_ = command.text(0);
    } else if (name == "print") {
        print(command);
    } else if (name == "copy") {
        copy_command_line();
    } else if (name == "wait") {
        script_resumes_s_ = now_s() + command.number(0);
    } else {
        window_.close();  // quit
    }
}

void App::print(const ScriptCommand& command) const {
    const std::string& what = command.text(0);
    if (what == "command")
        std::cout << model_.command_line() << '\n';
    else if (what == "error")
        for (const DrawnSide& side : shown_.sides) std::cout << "error: " << side.error << '\n';
    else if (what == "fps")
        std::cout << "fps: " << support::fixed(model_.times(0).frames_per_second().value_or(0), 1)
                  << '\n';
    else if (what == "status")
        std::cout << "status: " << model_.status << '\n';
    else if (what != "list")
        command.refuse("there is nothing of this name to print");
    else {
        const auto& list = shown_.sides[0].list;
        std::cout << "list: " << (list ? std::to_string(list->size()) : "none") << '\n';
        if (list)
            for (const ListEntry& entry : *list)
                std::cout << support::shortest(entry.depth) << ' ' << entry.colour[0] << ' '
                          << entry.colour[1] << ' ' << entry.colour[2] << ' ' << entry.alpha
                          << '\n';
    }
    std::cout.flush();
}

}  // namespace viewer
