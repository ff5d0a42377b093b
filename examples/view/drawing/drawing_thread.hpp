// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drawing/side_drawer.hpp"

namespace viewer {

/// A file to write of what was drawn last.
struct SaveRequest {
    std::filesystem::path path;
    /// Right of this part of the width, the picture is that of the right side, where there is one.
    double split_at = 1;
};

/// Draws requests on a thread of its own, so that the window never waits for a device. The last
/// request counts: one that waits is replaced by the next.
class DrawingThread {
public:
    /// `wake` is called on that thread when there is something to take.
    explicit DrawingThread(std::function<void()> wake);
    /// Ends the frame in progress, and long work early.
    ~DrawingThread();
    DrawingThread(const DrawingThread&) = delete;
    DrawingThread& operator=(const DrawingThread&) = delete;

    void draw(Request request);
    /// Writes a file after everything that was asked for before is drawn.
    void save(SaveRequest request);

    /// The last answer, if it was not taken yet.
    [[nodiscard]] std::optional<Drawn> take();
    /// What became of files, in order: each message once.
    [[nodiscard]] std::vector<std::string> take_messages();

    /// Whether a request waits for a frame in progress.
    [[nodiscard]] bool has_waiting() const;
    /// Whether everything is drawn, written and taken.
    [[nodiscard]] bool is_idle() const;
    /// The progress of long work from 0 to 1, or less than 0.
    [[nodiscard]] double progress() const { return progress_; }

private:
    void run();
    void draw_now(const Request& request);
    [[nodiscard]] std::string save_now(const SaveRequest& request);
    void use_device(const std::string& name);
    void interrupt_or_show(double part);

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool stops_ = false;
    bool is_busy_ = false;
    std::optional<Request> waiting_;
    std::vector<SaveRequest> saves_;
    std::optional<Drawn> drawn_;
    std::vector<std::string> messages_;
    std::atomic<double> progress_ = -1;

    // Of the thread alone.
    std::string device_name_;
    std::optional<cellist::Device> device_;
    std::optional<Studio> studio_;
    std::array<std::unique_ptr<SideDrawer>, 2> sides_;
    Request in_progress_;
    bool shows_heat_map_ = false;

    std::thread thread_;  // last: it uses the other members
};

}  // namespace viewer
