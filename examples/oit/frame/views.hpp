// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>

#include "frame/frame.hpp"
#include "raster/view.hpp"

namespace oit {

/// The view from a place on the lens. `place` is in radii of the lens from its centre, to the right
/// and down. Surfaces in focus do not move in the image. A point at depth z moves by the focal
/// length times radius * place * (1 / focus - 1 / z).
[[nodiscard]] raster::View through_lens(const raster::View& view, const Lens& lens,
                                        const glm::dvec2& place);

/// The view whose pixel centres lie `pixels` farther to the right and down.
[[nodiscard]] raster::View moved_by(const raster::View& view, const glm::dvec2& pixels);

/// The size in pixels of a length of 1 at a depth of 1, in the middle of the image.
[[nodiscard]] double focal_length_pixels(const raster::View& view);

/// The i-th of `count` places that are spread evenly over a disc of radius 1 (Vogel 1979).
[[nodiscard]] glm::dvec2 place_on_disc(std::size_t i, std::size_t count);

}  // namespace oit
