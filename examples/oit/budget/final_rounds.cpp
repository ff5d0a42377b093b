// SPDX-License-Identifier: MIT
#include "budget/final_rounds.hpp"

#include <algorithm>
#include <utility>

namespace oit {

int draws_of(double ms, int least) {
    constexpr double enough_ms = 15;
    return std::max(least, std::min(32, static_cast<int>(enough_ms / ms)));
}

FinalRounds::FinalRounds(DrawnSettings settings, std::function<bool()> is_over_time)
    : left_(std::move(settings)), is_over_time_(std::move(is_over_time)) {}

std::uint32_t FinalRounds::draw(double best_ms) {
    constexpr int rounds = 3;
    std::uint32_t draws = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round > 0 && (left_.size() < 2 || is_over_time_())) break;
        const double least = round == 0 ? best_ms : fastest().median_ms;
        draws += draw_interleaved(draws_of(least, std::max(3, 2 << round)), round == 0);
        drop_slower(1 + (first_margin - 1) / (2 << round));
    }
    return draws;
}

std::uint32_t FinalRounds::draw_interleaved(int times, bool at_least_three) {
    std::uint32_t draws = 0;
    for (int i = 0; i < times; ++i) {
        if (is_over_time_() && !(at_least_three && i < 3)) break;
        for (const auto& setting : left_) setting->times_ms.push_back(setting->renderer.draw());
        draws += static_cast<std::uint32_t>(left_.size());
    }
    return draws;
}

Spread FinalRounds::fastest() const {
    std::vector<Spread> spreads;
    for (const auto& setting : left_) spreads.push_back(spread_of(setting->times_ms));
    return *std::ranges::min_element(spreads, {}, &Spread::median_ms);
}

void FinalRounds::drop_slower(double margin) {
    const Spread least = fastest();
    std::erase_if(left_, [&](const std::shared_ptr<DrawnSetting>& setting) {
        const Spread times = spread_of(setting->times_ms);
        const bool is_out =
            times.median_ms > margin * least.median_ms && measurably_slower(times, least);
        if (is_out) slower_.push_back(setting);
        return is_out;
    });
}

std::shared_ptr<DrawnSetting> FinalRounds::choose() {
    std::vector<Timed> timed;
    for (const auto& setting : left_)
        timed.push_back({setting->candidate.setting, spread_of(setting->times_ms)});
    std::shared_ptr<DrawnSetting> chosen = left_.at(plainest_of_fastest(timed));
    const auto complete = [&](DrawnSetting& setting, Candidate::Outcome outcome) {
        setting.candidate.outcome = outcome;
        setting.candidate.times = spread_of(setting.times_ms);
        setting.candidate.times_chosen = setting.times(*chosen);
        setting.candidate.fastest_ms = setting.candidate.times->least_ms;
    };
    const Spread least = fastest();
    for (const auto& setting : slower_) complete(*setting, Candidate::Outcome::slower);
    for (const auto& setting : left_)
        complete(*setting, setting == chosen ? Candidate::Outcome::chosen
                           : measurably_slower(spread_of(setting->times_ms), least)
                               ? Candidate::Outcome::slower
                               : Candidate::Outcome::as_fast);
    return chosen;
}

DrawnSettings FinalRounds::settings() const {
    DrawnSettings all = slower_;
    all.insert(all.end(), left_.begin(), left_.end());
    return all;
}

}  // namespace oit
