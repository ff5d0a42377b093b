#include "keeper.hpp"

#include <algorithm>
#include <cstring>

namespace oit {
namespace {

bool same_views(const Frame& a, const Frame& b) {
    return std::ranges::equal(a.views, b.views, [](const raster::View& x, const raster::View& y) {
        return std::memcmp(&x, &y, sizeof(raster::View)) == 0;
    });
}

}  // namespace

Keeper::Keeper(const cellist::Device& device, const Frame& frame, const Budget& budget,
               std::uint32_t check_every)
    : chooser_(device, frame, budget), budget_(budget), check_every_(check_every), now_(frame) {
    choose();
}

void Keeper::choose() {
    choice_ = chooser_.choose();
    renderer_ = &chooser_.renderer();
}

bool Keeper::has_changed() const {
    const Frame& frame = chooser_.frame();
    return frame.time != now_.time || !same_views(frame, now_);
}

Keeper::Drawn Keeper::draw() {
    Drawn drawn{.met = choice_.met, .errors = choice_.errors};
    if (!has_changed()) {
        drawn.frame_ms = renderer_->draw();
        return drawn;
    }
    const Frame& frame = chooser_.frame();
    now_.time = frame.time;
    now_.views = frame.views;
    drawn.frame_ms = chooser_.draw_changed();
    if (++unchecked_ < check_every_) return drawn;
    unchecked_ = 0;
    drawn.checked = true;
    drawn.errors = chooser_.check();
    drawn.met = budget_.met_by(drawn.errors.told);
    if (drawn.met) return drawn;
    choose();
    drawn.chosen_again = true;
    drawn.met = choice_.met;
    drawn.errors = choice_.errors;
    drawn.frame_ms = renderer_->draw();
    return drawn;
}

}  // namespace oit
