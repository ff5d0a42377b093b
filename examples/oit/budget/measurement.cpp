// SPDX-License-Identifier: MIT
#include "budget/measurement.hpp"

#include <exception>
#include <numeric>

#include "first_line.hpp"
#include "methods/renderer.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

constexpr double most_ms = 10'000;  // so that a slow method does not hold up all others

std::vector<double> time_frames(Renderer& renderer, std::uint32_t frames) {
    const support::Stopwatch stopwatch;
    renderer.warm_up();
    std::vector<double> times;
    do times.push_back(renderer.draw());
    while (times.size() < frames && stopwatch.ms() < most_ms);
    return times;
}

}  // namespace

void Measurement::add(const std::vector<double>& more) {
    times.insert(times.end(), more.begin(), more.end());
    const Spread of_times = spread_of(times);
    fastest = of_times.least_ms;
    milliseconds = of_times.median_ms;
    lower_quartile = of_times.lower_quartile_ms;
    upper_quartile = of_times.upper_quartile_ms;
}

Measurement measure(const cellist::Device& device, const Frame& frame, const Setting& setting,
                    const Reference& reference, std::uint32_t frames) {
    Measurement result{.setting = setting};
    const Frame drawn = with_setting(frame, setting);
    try {
        Renderer renderer(device, drawn, *setting.method);
        result.add(time_frames(renderer, frames));
        result.bytes = renderer.method().device_bytes();
        result.image = renderer.image();
    } catch (const std::exception& error) {
        result.failure = support::first_line(error.what());
        return result;
    }
    result.comparison = compare(reference, result.image, {});
    return result;
}

void measure_again(const cellist::Device& device, const Frame& frame, std::uint32_t frames,
                   Measurement& measurement) {
    const std::vector<double>& times = measurement.times;
    if (!measurement.drawn() || std::accumulate(times.begin(), times.end(), 0.0) >= most_ms) return;
    const Frame drawn = with_setting(frame, measurement.setting);
    try {
        Renderer renderer(device, drawn, *measurement.setting.method);
        measurement.add(time_frames(renderer, frames));
    } catch (const std::exception& error) {
        measurement.failure = support::first_line(error.what());
    }
}

}  // namespace oit
