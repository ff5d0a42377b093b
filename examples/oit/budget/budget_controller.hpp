// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "budget/budget_search.hpp"

namespace oit {

/// Draws frames of a changing scene within a budget.
///
/// What was chosen for one moment need not do for the next. Each frame whose time or views differ
/// from those of the last is surveyed and compared; where it is over the budget, a setting is
/// chosen again and the frame drawn again. With `check_every` N, a check follows N frames of which
/// nothing is known, the last of them included: for speed, where the picture changes little.
class BudgetController {
public:
    /// A frame that was drawn.
    struct Drawn {
        double frame_ms = 0;
        bool changed = false;  ///< another moment than that of the last frame
        /// Surveyed for this frame: behind it, or, of the first, when the setting was chosen.
        bool checked = false;
        bool chosen_again = false;
        /// Where this moment was checked, now or before.
        std::optional<PictureErrors> errors = {};
    };

    /// Chooses for the frame as it is. Refers to the device and the frame, which must outlive it;
    /// the frame may be given other times, and other views of the same size, between calls of
    /// draw().
    BudgetController(const cellist::Device& device, const Frame& frame, const Budget& budget,
                     std::uint32_t check_every = 1, SearchOptions options = {});

    /// Draws the frame as it is now. Blocks.
    Drawn draw();

    /// The last choice.
    [[nodiscard]] const Choice& choice() const { return choice_; }
    [[nodiscard]] Renderer& renderer() const { return search_.renderer(); }

private:
    void choose();
    [[nodiscard]] bool has_changed() const;

    BudgetSearch search_;
    Budget budget_;
    std::uint32_t check_every_;
    bool is_first_ = true;                      ///< the next frame
    std::uint32_t unchecked_ = 0;               ///< frames since the last check
    std::optional<PictureErrors> errors_ = {};  ///< of this moment, where they are known
    Choice choice_;
    Frame now_;  ///< as it was drawn last
};

}  // namespace oit
