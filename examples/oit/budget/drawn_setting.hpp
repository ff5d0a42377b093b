// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "budget/budget_search.hpp"
#include "stopwatch.hpp"

namespace oit {

/// A candidate with a renderer that draws it.
struct DrawnSetting {
    Candidate candidate;
    Frame frame;
    Renderer renderer;
    PictureErrors errors = {};
    support::Least least = {};          ///< frame time before the final rounds
    std::vector<double> times_ms = {};  ///< frame times of the final rounds

    DrawnSetting(const cellist::Device& device, const Frame& of, const Setting& setting)
        : candidate{.setting = setting},
          frame(with_setting(of, setting)),
          renderer(device, frame, *setting.method) {}

    [[nodiscard]] double ms() const { return least.ms(); }

    /// How many times as long as `other` it takes, by the medians of the frames that both drew.
    [[nodiscard]] double times(const DrawnSetting& other) const {
        const auto count = static_cast<std::ptrdiff_t>(times_ms.size());
        return support::median(times_ms) /
               support::median({other.times_ms.begin(), other.times_ms.begin() + count});
    }
};

}  // namespace oit
