#pragma once

#include <cstdint>

#include "chooser.hpp"

namespace oit {

/// Draws frames of a changing scene within a budget.
///
/// What was chosen for one moment need not do for the next. Each frame whose time or views differ from
/// those of the last check is surveyed and compared; where it is over the budget, a setting is chosen
/// again and the frame drawn again. With `check_every` N, only each N-th of the changed frames is
/// checked, and nothing is known of those between: for speed, where the picture changes little.
class Keeper {
public:
    /// A frame that was drawn.
    struct Drawn {
        double frame_ms = 0;
        bool checked = false;
        bool chosen_again = false;
        bool met = true;
        PictureErrors errors = {};  ///< where it was checked
    };

    /// Chooses for the frame as it is. Refers to the device and the frame, which must outlive it; the
    /// frame may be given other times, and other views of the same size, between calls of draw().
    Keeper(const cellist::Device& device, const Frame& frame, const Budget& budget,
           std::uint32_t check_every = 1);

    /// Draws the frame as it is now. Blocks.
    Drawn draw();

    /// The last choice.
    [[nodiscard]] const Choice& choice() const { return choice_; }
    [[nodiscard]] Renderer& renderer() const { return *renderer_; }

private:
    void choose();
    [[nodiscard]] bool has_changed() const;

    Chooser chooser_;
    Budget budget_;
    std::uint32_t check_every_;
    std::uint32_t unchecked_ = 0;  ///< changed frames since the last check
    Choice choice_;
    Frame now_;  ///< as it was drawn last
    Renderer* renderer_ = nullptr;
};

}  // namespace oit
