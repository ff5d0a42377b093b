// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "budget/drawn_setting.hpp"

namespace oit {

using DrawnSettings = std::vector<std::shared_ptr<DrawnSetting>>;

/// A setting is out after two draws if it is slower than the fastest by this factor. With more
/// draws, a smaller factor is enough.
inline constexpr double first_margin = 1.3;

/// Draws of a frame that takes `ms`: more for short frames, up to some time.
[[nodiscard]] int draws_of(double ms, int least);

/// The last part of a search. The settings within the budget draw interleaved, so that other work
/// on the machine slows all of them alike. After each round, settings that are measurably slower
/// leave. Earlier times do not count: they are of other moments, and of different numbers of
/// frames.
class FinalRounds {
public:
    /// `settings` has at least one.
    FinalRounds(DrawnSettings settings, std::function<bool()> is_over_time);

    /// Draws all rounds, the first for a frame of `best_ms`. Returns how many frames it drew.
    /// Blocks.
    std::uint32_t draw(double best_ms);

    /// The plainest of the fastest settings. Completes the candidates of all settings.
    [[nodiscard]] std::shared_ptr<DrawnSetting> choose();

    /// All settings: those that left come first.
    [[nodiscard]] DrawnSettings settings() const;

private:
    std::uint32_t draw_interleaved(int times, bool at_least_three);
    [[nodiscard]] Spread fastest() const;
    void drop_slower(double margin);

    DrawnSettings left_;
    DrawnSettings slower_;
    std::function<bool()> is_over_time_;
};

}  // namespace oit
