// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "budget/budget.hpp"
#include "budget/budget_controller.hpp"

namespace oit {

/// Whether each frame of a run was within the budget.
class BudgetRecord {
public:
    void add(const BudgetController::Drawn& drawn, double time, const Budget& budget);

    /// No frame that was checked is over the budget; undecided pixels count where it is strict.
    [[nodiscard]] bool met() const { return over_.empty(); }
    /// Undecided pixels that may be over the limit: of the frame that has the most, where they do
    /// not count and keep the frame from being within the budget.
    [[nodiscard]] std::uint64_t undecided_pixels() const { return undecided_pixels_; }
    /// "met", "met except 1 undecided pixel" or "not met".
    [[nodiscard]] std::string verdict() const;
    [[nodiscard]] std::uint32_t frames() const { return frames_; }
    /// Frames that show another moment than the one before.
    [[nodiscard]] std::uint32_t changed() const { return changed_; }
    [[nodiscard]] std::uint32_t checked() const { return checked_; }
    [[nodiscard]] std::uint32_t chosen_again() const { return chosen_again_; }
    /// Times of the frames that no setting brings within the budget.
    [[nodiscard]] const std::vector<double>& over() const { return over_; }
    /// The first of these frames, counted from 1; 0 where there is none.
    [[nodiscard]] std::uint32_t first_over() const { return first_over_; }
    /// The errors of the least accurate frame that was checked.
    [[nodiscard]] const PictureErrors& worst() const { return worst_; }

private:
    std::uint32_t frames_ = 0, changed_ = 0, checked_ = 0, chosen_again_ = 0, first_over_ = 0;
    std::uint64_t undecided_pixels_ = 0;
    std::vector<double> over_;
    PictureErrors worst_;
};

/// What was chosen, and why: the end of a screen for people.
void print(const Choice& choice, const Budget& budget, const BudgetRecord& record,
           std::ostream& out);

/// The same, and all candidates.
[[nodiscard]] nlohmann::ordered_json json_of(const Choice& choice, const Budget& budget,
                                             const BudgetRecord& record);

}  // namespace oit
