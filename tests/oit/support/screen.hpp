// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <cellist/cellist.hpp>

#include "mesh.hpp"
#include "raster/rasteriser.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/internals.hpp"

namespace cellist::test {

/// What the rasteriser made of a mesh: for each sample how often it was covered, and for each pixel
/// the depth of one of the fragments.
struct Coverage {
    std::vector<cl_uint> counts;
    std::vector<cl_float> depths;
};

/// A view in which the position (x, y, 1) is the point x, y of the image, in pixels from its
/// centre, y down. Positions that are multiples of 1/256 are snapped to themselves.
inline raster::View pixel_view(int width, int height) {
    raster::View view{};
    view.row_x[0] = RASTER_SUBPIXELS;
    view.row_y[1] = RASTER_SUBPIXELS;
    view.row_w[2] = 1;
    view.near_depth = 0.5F;
    view.width = width;
    view.height = height;
    return view;
}

/// Draws a mesh through the rasteriser, with a pass that counts.
inline Coverage coverage_on(const Device& device, const support::Mesh& mesh,
                            const raster::View& view, const raster::Sampling& sampling) {
    constexpr auto source = R"(
#define RASTER_TARGET volatile global uint* counts, global float* depths
#define RASTER_TARGET_PASS counts, depths
static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const uint pixel = covered->y * view->width + covered->x;
    for (int s = 0; s < RASTER_SAMPLES; ++s)
        if (covered->coverage >> s & 1) atomic_inc(&counts[pixel * RASTER_SAMPLES + s]);
    depths[pixel] = covered->depth;
}
)";
    raster::SetupKernels setup(device, sampling);
    raster::Pass pass(device, sampling, source, "count.cl");
    const support::Mesh* const meshes[] = {&mesh};
    const raster::Geometry geometry(device, meshes);
    const raster::Placed placed[] = {{}};
    raster::Projection projection(device, setup, geometry, placed, std::span(&view, 1));
    const std::size_t all[] = {0};
    raster::Triangles triangles(device, projection, all);
    const auto pixels =
        static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    Buffer<cl_uint> counts(device, pixels * static_cast<std::size_t>(sampling.samples));
    Buffer<cl_float> depths(device, pixels);
    projection.transform();
    do {
        counts.fill(0);
        depths.fill(0);
        triangles.bin();
        triangles.draw(pass, counts, depths);
    } while (!triangles.finish_or_grow());
    return {counts.download(), depths.download()};
}

/// The same on the device of the tests. Requires the same counts where it draws as a GPU.
inline Coverage coverage_of(const support::Mesh& mesh, const raster::View& view,
                            const raster::Sampling& sampling = {}) {
    static const Device gpu = like_gpu();
    Coverage coverage = coverage_on(device(), mesh, view, sampling);
    REQUIRE(coverage_on(gpu, mesh, view, sampling).counts == coverage.counts);
    return coverage;
}

/// A point in 1/256 pixel from the centre of the image.
struct Point {
    int x, y;
};

/// Adds the triangle a, b, c to a mesh for pixel_view.
inline void add_triangle(support::Mesh& mesh, Point a, Point b, Point c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Point& p : {a, b, c}) {
        mesh.positions.emplace_back(static_cast<float>(p.x) / RASTER_SUBPIXELS,
                                    static_cast<float>(p.y) / RASTER_SUBPIXELS, 1.0F);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace cellist::test
