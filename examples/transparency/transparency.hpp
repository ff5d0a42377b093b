// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <cellist/cellist.hpp>
#include <cellist/glm.hpp>

#include "mesh.hpp"
#include "raster/view.hpp"

namespace transparency {

/// What a triangle leaves in a pixel. The kernels know the struct by the same name.
struct Fragment {
    cl_float depth;    ///< along the viewing direction
    glm::vec3 colour;  ///< linear RGB
    cl_float alpha;    ///< the part of the light behind it that it hides
};
CELLIST_STRUCT(Fragment, depth, colour, alpha);

/// How every surface looks.
struct Surface {
    glm::vec3 colour{0.05F, 0.42F, 0.60F};
    cl_float alpha = 0.3F;                  ///< of a surface that faces the eye
    glm::vec3 light{-0.48F, 0.64F, 0.60F};  ///< the direction to the light, of length 1
    glm::vec3 background{0.90F, 0.90F, 0.88F};
};
CELLIST_STRUCT(Surface, colour, alpha, light, background);

/// A picture and what the lists held.
struct Picture {
    std::vector<cl_float4> pixels;  ///< linear RGB, row by row from the top
    cellist::Lengths layers;        ///< of the pixels
};

/// Draws a mesh whose every surface is transparent. The order of the triangles does not matter.
/// Blocks. Throws cellist::Error where the device cannot do it.
[[nodiscard]] Picture draw(const cellist::Device& device, const support::Mesh& mesh,
                           const raster::View& view, const Surface& surface = {});

}  // namespace transparency
