// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

#include <cellist/device.hpp>

namespace support {

/// Milliseconds since it was made.
class Stopwatch {
public:
    [[nodiscard]] double ms() const {
        return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// The milliseconds from the call of `work` to the end of everything that it enqueued.
double measure_ms(const cellist::Device& device, std::invocable auto&& work) {
    device.finish();
    const Stopwatch stopwatch;
    work();
    device.finish();
    return stopwatch.ms();
}

/// The middle of some times, at least one.
[[nodiscard]] inline double median(std::vector<double> times_ms) {
    std::sort(times_ms.begin(), times_ms.end());
    const std::size_t half = times_ms.size() / 2;
    return times_ms.size() % 2 == 1 ? times_ms[half] : 0.5 * (times_ms[half - 1] + times_ms[half]);
}

/// The least of some times. On a machine that does other work, the one that was disturbed least.
class Least {
public:
    void add(double ms) { least_ms_ = std::min(least_ms_, ms); }
    [[nodiscard]] double ms() const { return least_ms_; }

private:
    double least_ms_ = std::numeric_limits<double>::infinity();
};

}  // namespace support
