// SPDX-License-Identifier: MIT
#include "drawing/drawing_thread.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "drawing/interrupted.hpp"
#include "files.hpp"
#include "heat_map.hpp"
#include "image.hpp"
#include "input_error.hpp"

namespace viewer {
namespace {

// Whether the requests differ only in what changes from frame to frame.
bool same_settings(const Request& a, const Request& b) {
    if (a.program != b.program || a.sides.size() != b.sides.size()) return false;
    return std::ranges::equal(a.sides, b.sides, [](const Arguments& x, const Arguments& y) {
        return x.without({"--view", "--zoom", "--time"}) ==
               y.without({"--view", "--zoom", "--time"});
    });
}

template <class Pixel>
std::vector<Pixel> joined_at(std::vector<Pixel> left, const std::vector<Pixel>& right,
                             std::pair<int, int> size, double split_at) {
    const auto width = static_cast<std::size_t>(size.first);
    const auto column = static_cast<std::size_t>(
        std::lround(std::clamp(split_at, 0.0, 1.0) * static_cast<double>(width)));
    for (std::size_t row = 0; row < left.size(); row += width)
        for (std::size_t x = column; x < width; ++x) left[row + x] = right[row + x];
    return left;
}

}  // namespace

DrawingThread::DrawingThread(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this] { run(); }) {}

DrawingThread::~DrawingThread() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void DrawingThread::draw(Request request) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = std::move(request);
    }
    changed_.notify_one();
}

void DrawingThread::save(SaveRequest request) {
    {
        const std::lock_guard lock(mutex_);
        saves_.push_back(std::move(request));
    }
    changed_.notify_one();
}

std::optional<Drawn> DrawingThread::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(drawn_, std::nullopt);
}

std::vector<std::string> DrawingThread::take_messages() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

bool DrawingThread::has_waiting() const {
    const std::lock_guard lock(mutex_);
    return waiting_.has_value();
}

bool DrawingThread::is_idle() const {
    const std::lock_guard lock(mutex_);
    return !is_busy_ && !waiting_ && saves_.empty() && !drawn_ && messages_.empty();
}

void DrawingThread::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        is_busy_ = false;
        changed_.wait(lock, [&] { return stops_ || waiting_ || !saves_.empty(); });
        if (stops_) break;
        is_busy_ = true;
        if (waiting_) {
            const Request request = *std::exchange(waiting_, std::nullopt);
            in_progress_ = request;
            lock.unlock();
            draw_now(request);
            lock.lock();
        } else {
            const SaveRequest request = saves_.front();
            lock.unlock();
            std::string message = save_now(request);
            lock.lock();
            saves_.erase(saves_.begin());
            messages_.push_back(std::move(message));
        }
        lock.unlock();
        wake_();
        lock.lock();
    }
    // Here, and not with the members: a device belongs to its thread.
    lock.unlock();
    for (std::unique_ptr<SideDrawer>& side : sides_) side.reset();
}

void DrawingThread::draw_now(const Request& request) {
    Drawn drawn{.request = request};
    try {
        use_device(request.sides.front().get("--device"));
        for (std::size_t side = 0; side < request.sides.size(); ++side) {
            if (!sides_[side]) sides_[side] = std::make_unique<SideDrawer>(*studio_);
            drawn.sides.push_back(sides_[side]->draw(request, side));
        }
        if (request.sides.size() < sides_.size()) sides_.back().reset();
        shows_heat_map_ = request.heat_map;
    } catch (const Interrupted&) {
        progress_ = -1;
        return;
    } catch (const std::exception& error) {
        drawn.sides.assign(request.sides.size(), {.error = error.what()});
    }
    progress_ = -1;
    const std::lock_guard lock(mutex_);
    drawn_ = std::move(drawn);
}

void DrawingThread::use_device(const std::string& name) {
    if (device_ && name == device_name_) return;
    for (std::unique_ptr<SideDrawer>& side : sides_) side.reset();
    studio_.reset();
    device_.reset();
    device_.emplace(name.empty() ? cellist::Device::choose() : cellist::Device::choose(name));
    device_name_ = name;
    studio_.emplace(Studio{*device_, [this](double part) { interrupt_or_show(part); }});
}

void DrawingThread::interrupt_or_show(double part) {
    {
        const std::lock_guard lock(mutex_);
        if (stops_ || (waiting_ && !same_settings(*waiting_, in_progress_))) throw Interrupted();
    }
    progress_ = part;
    wake_();
}

std::string DrawingThread::save_now(const SaveRequest& request) {
    const std::string name = support::text_of(request.path);
    try {
        const SideDrawer* left = sides_.front().get();
        if (left == nullptr || left->size().first == 0)
            throw support::InputError("there is no picture to save");
        const auto [width, height] = left->size();
        const SideDrawer* right = sides_.back().get();
        if (right != nullptr && right->size() != left->size()) right = nullptr;
        if (shows_heat_map_) {
            std::vector<cl_uint> counts = left->list_lengths()->counts;
            if (right != nullptr)
                counts = joined_at(std::move(counts), right->list_lengths()->counts, left->size(),
                                   request.split_at);
            support::write_heat_map(request.path,
                                    {.values = std::vector<double>(counts.begin(), counts.end()),
                                     .width = width,
                                     .height = height,
                                     .caption = left->list_lengths()->caption});
        } else {
            std::vector<cl_float4> image = left->linear_image();
            if (right != nullptr)
                image = joined_at(std::move(image), right->linear_image(), left->size(),
                                  request.split_at);
            support::write_image(request.path, image, width, height);
        }
        return "saved " + name;
    } catch (const std::exception& error) {
        return "not saved: " + std::string(error.what());
    }
}

}  // namespace viewer
