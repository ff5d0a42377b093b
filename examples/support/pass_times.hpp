// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <cellist/device.hpp>

#include "stopwatch.hpp"

namespace support {

/// Milliseconds of each pass, in the order of their first run. Waits after every pass, so that
/// passes do not overlap: their sum exceeds the time of a frame.
class PassTimes {
public:
    explicit PassTimes(const cellist::Device& device) : device_(device) { device_.finish(); }

    /// The pass that ends here. Blocks.
    void end(const std::string& pass) {
        device_.finish();
        const double ms = watch_.ms();
        const auto known = std::ranges::find(times_, pass, &std::pair<std::string, double>::first);
        if (known == times_.end())
            times_.emplace_back(pass, ms);
        else
            known->second += ms;
        watch_ = Stopwatch();
    }
    [[nodiscard]] const std::vector<std::pair<std::string, double>>& all() const { return times_; }

private:
    const cellist::Device& device_;
    Stopwatch watch_;
    std::vector<std::pair<std::string, double>> times_;
};

/// The median times of the passes of some frames, at least one, which `draw` draws.
[[nodiscard]] inline std::vector<std::pair<std::string, double>> median_passes(
    const cellist::Device& device, std::uint32_t frames, std::invocable<PassTimes&> auto&& draw) {
    std::vector<std::vector<std::pair<std::string, double>>> drawn;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        PassTimes times(device);
        draw(times);
        drawn.push_back(times.all());
    }
    std::vector<std::pair<std::string, double>> result = drawn.front();
    for (std::size_t pass = 0; pass < result.size(); ++pass) {
        std::vector<double> ms;
        for (const auto& frame : drawn) ms.push_back(frame[pass].second);
        result[pass].second = median(ms);
    }
    return result;
}

}  // namespace support
