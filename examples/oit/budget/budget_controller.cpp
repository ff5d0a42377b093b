// SPDX-License-Identifier: MIT
#include "budget/budget_controller.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace oit {
namespace {

bool same_views(const Frame& a, const Frame& b) {
    return std::ranges::equal(a.views, b.views, [](const raster::View& x, const raster::View& y) {
        return std::memcmp(&x, &y, sizeof(raster::View)) == 0;
    });
}

}  // namespace

BudgetController::BudgetController(const cellist::Device& device, const Frame& frame,
                                   const Budget& budget, std::uint32_t check_every,
                                   SearchOptions options)
    : search_(device, frame, budget, std::move(options)),
      budget_(budget),
      check_every_(check_every),
      now_(frame) {
    choose();
}

void BudgetController::choose() {
    choice_ = search_.run();
    errors_ = choice_.errors;
}

bool BudgetController::has_changed() const {
    const Frame& frame = search_.frame();
    return frame.time != now_.time || !same_views(frame, now_);
}

BudgetController::Drawn BudgetController::draw() {
    Drawn drawn{.changed = has_changed()};
    drawn.checked = std::exchange(is_first_, false) && !drawn.changed;
    const Frame& frame = search_.frame();
    if (drawn.changed) {
        now_.time = frame.time;
        now_.views = frame.views;
        errors_.reset();
        drawn.frame_ms = search_.draw_changed();
    } else {
        drawn.frame_ms = renderer().draw();
    }
    if (!errors_ && ++unchecked_ >= check_every_) {
        unchecked_ = 0;
        drawn.checked = true;
        errors_ = search_.check();
        if (!budget_.met_by(*errors_)) {
            choose();
            drawn.chosen_again = true;
            drawn.frame_ms = renderer().draw();
        }
    }
    drawn.errors = errors_;
    return drawn;
}

}  // namespace oit
