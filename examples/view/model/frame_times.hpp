// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace viewer {

/// Times of the last frames.
class FrameTimes {
public:
    static constexpr std::size_t most = 120;

    /// A frame that took `frame_ms` to draw and was there at `now_s`.
    void add(double frame_ms, double now_s) {
        if (milliseconds_.size() == most) {
            milliseconds_.erase(milliseconds_.begin());
            arrivals_s_.erase(arrivals_s_.begin());
        }
        milliseconds_.push_back(static_cast<float>(frame_ms));
        arrivals_s_.push_back(now_s);
    }
    void clear() { *this = {}; }

    [[nodiscard]] std::span<const float> milliseconds() const { return milliseconds_; }
    /// Over the last second or so, pauses of half a second left out; nothing after fewer than two
    /// frames.
    [[nodiscard]] std::optional<double> frames_per_second() const {
        std::size_t first = arrivals_s_.size();
        if (first == 0) return {};
        --first;
        while (first > 0 && arrivals_s_[first] - arrivals_s_[first - 1] < 0.5 &&
               arrivals_s_.back() - arrivals_s_[first] < 1)
            --first;
        const double seconds = arrivals_s_.back() - arrivals_s_[first];
        if (seconds <= 0) return {};
        return static_cast<double>(arrivals_s_.size() - 1 - first) / seconds;
    }

private:
    std::vector<float> milliseconds_;
    std::vector<double> arrivals_s_;
};

}  // namespace viewer
