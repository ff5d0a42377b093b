// SPDX-License-Identifier: MIT
#include "support/timing.hpp"

#include <algorithm>

namespace bench {

Samples summary(std::vector<double> seconds) {
    std::sort(seconds.begin(), seconds.end());
    const std::size_t middle = seconds.size() / 2;
    const double median =
        seconds.size() % 2 == 1 ? seconds[middle] : (seconds[middle - 1] + seconds[middle]) / 2;
    return {median, seconds.front(), seconds.back(), seconds.size()};
}

std::vector<Samples> sample(const Sampling& sampling,
                            const std::function<std::vector<double>()>& run) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(sampling.seconds);
    std::vector<std::vector<double>> times;
    for (std::size_t i = 0; i < sampling.least || (i < sampling.most && Clock::now() < end); ++i) {
        const std::vector<double> once = run();
        times.resize(once.size());
        for (std::size_t what = 0; what < once.size(); ++what) times[what].push_back(once[what]);
    }
    std::vector<Samples> all;
    for (std::vector<double>& seconds : times) all.push_back(summary(std::move(seconds)));
    return all;
}

Samples sample(const Sampling& sampling, const std::function<double()>& run) {
    return sample(sampling, [&] { return std::vector<double>{run()}; }).front();
}

double device_seconds(const cl::Event& event) {
    event.wait();
    const auto begin = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return 1e-9 * static_cast<double>(end - begin);
}

}  // namespace bench
