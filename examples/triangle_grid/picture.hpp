// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include <cellist/cellist.hpp>

#include "grid/triangle_grid.hpp"
#include "mesh.hpp"

namespace triangle_grid {

struct PictureOptions {
    std::filesystem::path out;
    int width = 960;
    int height = 640;
    int samples = 16;  ///< segments from the eye a pixel
};

/// Draws the mesh, which fits into the unit sphere, on a floor: a picture of what the queries are
/// for. Triangle i of the grid is triangle i of the mesh; the grid may have more, which are not
/// seen. Returns the milliseconds that drawing took. Blocks. Throws as write_image() does.
double draw_picture(const cellist::Device& device, const grid::TriangleGrid& triangles,
                    const support::Mesh& mesh, const PictureOptions& options);

}  // namespace triangle_grid
