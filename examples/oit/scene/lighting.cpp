// SPDX-License-Identifier: MIT
#include "scene/lighting.hpp"

namespace oit {

Lighting studio_lighting(float floor_height) {
    return {
        .sky = {0.42F, 0.50F, 0.60F},
        .ground = {0.05F, 0.05F, 0.07F},
        .key = {1.10F, 1.02F, 0.90F},
        .key_direction = {0.45F, 0.77F, 0.452769F},
        .rim = {0.50F, 0.62F, 0.80F},
        .background_top = {0.012F, 0.017F, 0.028F},
        .background_bottom = {0.060F, 0.072F, 0.095F},
        .floor_light = {0.34F, 0.36F, 0.39F},
        .floor_dark = {0.09F, 0.10F, 0.125F},
        .floor_height = floor_height,
        .floor_square = 0.25F,
        .floor_fade_begin = 1.2F,
        .floor_fade_end = 3.2F,
        .floor_shadow = 0.45F,
        .floor_shadow_centre = {0, 0},
        .floor_shadow_radius = {0.75F, 0.75F},
    };
}

}  // namespace oit
