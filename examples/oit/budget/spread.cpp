// SPDX-License-Identifier: MIT
#include "budget/spread.hpp"

#include <algorithm>
#include <cmath>

namespace oit {
namespace {

// The value below which the part is, between two of the values where it is between them.
double quantile(const std::vector<double>& sorted, double part) {
    const double place = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

Spread spread_of(std::vector<double> times_ms) {
    std::ranges::sort(times_ms);
    return {times_ms.front(), quantile(times_ms, 0.25), quantile(times_ms, 0.5),
            quantile(times_ms, 0.75)};
}

bool measurably_slower(const Spread& a, const Spread& b) {
    return a.median_ms > equally_fast * b.median_ms && a.lower_quartile_ms > b.upper_quartile_ms;
}

std::size_t plainest_of_fastest(std::span<const Timed> settings) {
    const auto fastest = std::ranges::min_element(
        settings, {}, [](const Timed& timed) { return timed.times.median_ms; });
    auto plainest = fastest;
    for (auto at = settings.begin(); at != settings.end(); ++at)
        if (!measurably_slower(at->times, fastest->times) &&
            plainer(at->setting, plainest->setting))
            plainest = at;
    return static_cast<std::size_t>(plainest - settings.begin());
}

}  // namespace oit
