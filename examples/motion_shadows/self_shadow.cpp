// SPDX-License-Identifier: MIT
#include "self_shadow.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace motion {
namespace {

constexpr double deviations = 4;
constexpr double most_lit = 0.05;
constexpr double least_probability = 3.2e-5;

// How many dark samples are too many.
std::uint64_t too_many(std::uint64_t samples, double probability) {
    auto count = static_cast<std::uint64_t>(probability * static_cast<double>(samples));
    while (count <= samples && binomial_tail(count, samples, probability) >= least_probability)
        ++count;
    return count;
}

std::uint64_t dark_of(const cl_float4& pixel, std::uint32_t samples) {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(pixel.s[3]) * samples));
}

}  // namespace

double wilson_upper(double count, double trials, double z) {
    const double square = z * z;
    const double share = count / trials;
    return (share + square / (2 * trials) +
            z * std::sqrt(share * (1 - share) / trials + square / (4 * trials * trials))) /
           (1 + square / trials);
}

double binomial_tail(std::uint64_t count, std::uint64_t trials, double probability) {
    if (count == 0) return 1;
    if (count > trials || probability <= 0) return 0;
    if (probability >= 1) return 1;
    const auto n = static_cast<double>(trials);
    const double odds = probability / (1 - probability);
    const auto log_choose = [&](double k) {
        return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
    };
    const auto first = static_cast<double>(count);
    double term = std::exp(log_choose(first) + first * std::log(probability) +
                           (n - first) * std::log1p(-probability));
    double sum = 0;
    for (double k = first; k <= n; ++k) {
        sum += term;
        term *= (n - k) / (k + 1) * odds;
        // Terms that rise come before those that fall.
        if (k > n * probability && term < 1e-16 * sum) break;
    }
    return std::min(1.0, sum);
}

SelfShadowing self_shadowing(std::span<const cl_float4> picture, std::uint32_t samples,
                             std::span<const cl_float4> reference, std::uint32_t moments) {
    SelfShadowing result;
    std::map<std::uint64_t, std::uint64_t> limits;  // by dark moments of the reference
    for (std::size_t p = 0; p < picture.size(); ++p) {
        const std::uint64_t dark_moments = dark_of(reference[p], moments);
        const double probability =
            wilson_upper(static_cast<double>(dark_moments), moments, deviations);
        if (!(probability < most_lit)) continue;
        ++result.lit;
        const auto [limit, is_new] = limits.try_emplace(dark_moments, 0);
        if (is_new) limit->second = too_many(samples, probability);
        if (dark_of(picture[p], samples) >= limit->second) ++result.self_shadowed;
    }
    return result;
}

}  // namespace motion
