// SPDX-License-Identifier: MIT
#include "methods/lens_ranges.hpp"

#include "frame/views.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// As in lens_common.clh.
constexpr std::size_t tile_pixels = 8;

cellist::Range tiles_of(const Frame& frame) {
    const auto tiles = [](int side) {
        return (static_cast<std::size_t>(side) + tile_pixels - 1) / tile_pixels;
    };
    return {tiles(frame.width()), tiles(frame.height()), frame.views.size()};
}

std::size_t count_of(const cellist::Range& tiles) {
    return tiles.global[0] * tiles.global[1] * tiles.global[2];
}

}  // namespace

std::string lens_text(const std::string& defines, std::string_view source) {
    return std::string(kernels::lens_common_clh).append("\n").append(defines).append(source);
}

LensRanges::LensRanges(const FragmentSource& source)
    : scale_(static_cast<cl_float>(focal_length_pixels(source.frame().views.front()) *
                                   source.frame().lens->radius)),
      focus_(static_cast<cl_float>(1 / source.frame().lens->focus)),
      spread_(source.device(),
              cellist::Source{.text = lens_text("", kernels::lens_ranges_cl),
                              .file_name = "lens_ranges.cl"},
              "oit_spread_ranges"),
      tiles_(tiles_of(source.frame())),
      ranges_(source.device(), count_of(tiles_)),
      along_x_(source.device(), count_of(tiles_)) {}

void LensRanges::spread() {
    spread_.run(tiles_, ranges_, along_x_, cl_int{0}, scale_, focus_);
    spread_.run(tiles_, along_x_, ranges_, cl_int{1}, scale_, focus_);
}

}  // namespace oit
