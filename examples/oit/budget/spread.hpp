// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "budget/setting.hpp"

namespace oit {

/// How the times of some frames are spread, in milliseconds: half of them lie between the
/// quartiles.
struct Spread {
    double least_ms = 0;
    double lower_quartile_ms = 0;
    double median_ms = 0;
    double upper_quartile_ms = 0;
};

/// Of at least one time.
[[nodiscard]] Spread spread_of(std::vector<double> times_ms);

/// Medians that differ by no more than this factor count as equal.
inline constexpr double equally_fast = 1.03;

/// True where interleaved times show that `a` is slower than `b`: its median is greater by
/// more than `equally_fast`, and the quartiles of the two do not overlap.
[[nodiscard]] bool measurably_slower(const Spread& a, const Spread& b);

/// A setting, and the times of its frames.
struct Timed {
    Setting setting;
    Spread times;
};

/// The index of the plainest of the settings that are not measurably slower than the one with the
/// least median; see plainer().
[[nodiscard]] std::size_t plainest_of_fastest(std::span<const Timed> settings);

}  // namespace oit
