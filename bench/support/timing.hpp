// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include <cellist/cellist.hpp>

namespace bench {

/// The times of several runs, in seconds.
struct Samples {
    double median = 0;
    double least = 0;
    double greatest = 0;
    std::size_t count = 0;
};
[[nodiscard]] Samples summary(std::vector<double> seconds);

/// How often a case runs: at least `least` times, and then until `seconds` have passed, with
/// preparations, or it has run `most` times.
struct Sampling {
    std::size_t least = 7;
    std::size_t most = 101;
    double seconds = 0.3;
};

/// Calls `run` as often as `sampling` says. Each call returns the times of one run, one for each of
/// the interleaved measurements.
[[nodiscard]] std::vector<Samples> sample(const Sampling& sampling,
                                          const std::function<std::vector<double>()>& run);
[[nodiscard]] Samples sample(const Sampling& sampling, const std::function<double()>& run);

/// The device time of one command. Waits for it.
[[nodiscard]] double device_seconds(const cl::Event& event);

/// The host time until the device has done `work`, with launches.
template <class Work>
double host_seconds(const cellist::Device& device, const Work& work) {
    device.finish();
    const auto begin = std::chrono::steady_clock::now();
    work();
    device.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace bench
