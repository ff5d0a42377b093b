// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/cellist.hpp>

namespace oit {

/// Light, floor and background. Colours are linear; directions have length 1.
struct Lighting {
    cl_float sky[3];     ///< light from above
    cl_float ground[3];  ///< light from below
    cl_float key[3];     ///< colour of the key light
    cl_float key_direction[3];
    cl_float rim[3];  ///< added where a surface is seen edge-on
    cl_float background_top[3];
    cl_float background_bottom[3];
    cl_float floor_light[3];
    cl_float floor_dark[3];
    cl_float floor_height;
    cl_float floor_square;      ///< side of one square of the checkerboard
    cl_float floor_fade_begin;  ///< distance from the axis where the floor starts to fade out
    cl_float floor_fade_end;
    cl_float floor_shadow;            ///< darkness of the shadow under the object, 0 to 1
    cl_float floor_shadow_centre[2];  ///< x and z
    cl_float floor_shadow_radius[2];  ///< of an ellipse along x and z
};
CELLIST_STRUCT(Lighting, sky, ground, key, key_direction, rim, background_top, background_bottom,
               floor_light, floor_dark, floor_height, floor_square, floor_fade_begin,
               floor_fade_end, floor_shadow, floor_shadow_centre, floor_shadow_radius);

/// The lighting of the example's pictures, for an object inside of the unit sphere that stands on a
/// floor at `floor_height`.
[[nodiscard]] Lighting studio_lighting(float floor_height);

}  // namespace oit
