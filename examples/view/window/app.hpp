// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "drawing/drawing_thread.hpp"
#include "model/model.hpp"
#include "model/script.hpp"
#include "stopwatch.hpp"
#include "window/shown.hpp"
#include "window/window.hpp"

namespace viewer {

/// The viewer: a window that shows a model, a thread that draws it, and a script that may drive it.
class App {
public:
    /// The picture has this size in the beginning.
    App(Model model, std::pair<int, int> picture_size, std::vector<ScriptCommand> script);

    /// Until the window is closed or the script ends the program. Throws what a script's command
    /// throws.
    void run();

private:
    void animate();
    void send_request();
    void take_answers();
    void follow_window_size();
    /// Whether the window must be drawn again.
    [[nodiscard]] bool has_changed();
    void draw_window();
    void fulfil_wishes();
    void save(const std::string& path);
    void copy_command_line();

    void run_script();
    [[nodiscard]] bool is_settled() const;
    void run_command(const ScriptCommand& command);
    void print(const ScriptCommand& command) const;

    [[nodiscard]] float panel_width() const;
    [[nodiscard]] std::pair<int, int> wanted_picture_size() const;
    [[nodiscard]] double now_s() const { return clock_.ms() / 1000; }

    support::Stopwatch clock_;
    Model model_;
    Window window_;
    Shown shown_;
    std::deque<ScriptCommand> script_;
    std::optional<Request> sent_;
    int repeats_ = 0;  // of the same request
    std::pair<int, int> picture_size_, last_size_;
    double size_changed_s_ = 0, advanced_s_ = 0;
    bool is_shown_ = false;          // the last answer is that of the last request
    bool is_stale_ = true;           // the window shows what was before
    double changed_s_ = 0;           // time of the last input
    std::size_t answers_ = 0;        // that were taken
    std::size_t frames_wanted_ = 0;  // of answers_, for the script
    double script_resumes_s_ = 0;
    std::string title_;
    std::string screenshot_;  // to write when the window is drawn
    DrawingThread thread_;    // last: it wakes the window
};

}  // namespace viewer
