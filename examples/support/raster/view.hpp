// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <cellist/cellist.hpp>

#include "raster/definitions.h"

namespace raster {

/// A pinhole camera and an image, as the kernels take them.
struct View {
    /// Rows that take a position (x, y, z, 1) to clip coordinates: see definitions.h.
    cl_float row_x[4];
    cl_float row_y[4];
    cl_float row_w[4];
    /// The ray through the pixel centre (x, y), of length 1 along the viewing direction:
    /// ray_origin + x * ray_x + y * ray_y.
    cl_float ray_origin[3];
    cl_float ray_x[3];
    cl_float ray_y[3];
    cl_float eye[3];
    /// Nothing nearer than this is drawn.
    cl_float near_depth;
    cl_int width;
    cl_int height;
};
CELLIST_STRUCT(View, row_x, row_y, row_w, ray_origin, ray_x, ray_y, eye, near_depth, width, height);

/// A mesh at a place, as one of the views sees it.
struct RasterInstance {
    /// Rows that take a position of the mesh to clip coordinates of the view.
    cl_float row_x[4];
    cl_float row_y[4];
    cl_float row_w[4];
    /// Rows that take a normal of the mesh to the world; its length may change.
    cl_float normal_x[3];
    cl_float normal_y[3];
    cl_float normal_z[3];
    /// The index of a projected vertex is that of the mesh's vertex plus this, modulo 2^32.
    cl_uint vertex_offset;
    cl_uint eye;  ///< index of the view
    cl_uint tag;  ///< of the user
};
CELLIST_STRUCT(RasterInstance, row_x, row_y, row_w, normal_x, normal_y, normal_z, vertex_offset,
               eye, tag);

/// Consecutive vertices or triangles of an instance that a work-group takes.
struct RasterBatch {
    cl_uint instance;
    cl_uint first;
    cl_uint end;
};
CELLIST_STRUCT(RasterBatch, instance, first, end);

/// A projected vertex: sub-pixels, depth, and a bit for each clipping plane that it is outside of.
/// x and y are 0 where it is outside of any.
struct RasterVertex {
    cl_int x;
    cl_int y;
    cl_float w;
    cl_int outside;
};
CELLIST_STRUCT(RasterVertex, x, y, w, outside);

/// A triangle on the screen, or a piece of a clipped one, ready to be scanned: oriented so that its
/// edge functions are positive inside.
struct RasterTriangle {
    cl_int x[3], y[3];      ///< corners in sub-pixels
    cl_float inverse_w[3];  ///< 1 / w of the corners; w until raster_invert()
    cl_uint corner[3];      ///< vertices of the triangle in the meshes
    cl_float share[9];      ///< parts of these in each corner, three a corner; used where clipped
    cl_uint instance;
    cl_uint number;  ///< of the piece among those of all triangles that are drawn
    cl_int front;    ///< 1 where the corners run counter-clockwise on the screen
    cl_int clipped;
    cl_int x_begin, x_end, y_begin, y_end;  ///< pixels of which some part may be covered
};
CELLIST_STRUCT(RasterTriangle, x, y, inverse_w, corner, share, instance, number, front, clipped,
               x_begin, x_end, y_begin, y_end);

/// A block of pixels that a triangle touches.
struct RasterBlock {
    cl_uint triangle;  ///< in the queue of triangles
    cl_uint place;     ///< x + 65536 * y of its upper left pixel
};
CELLIST_STRUCT(RasterBlock, triangle, place);

/// Entries of the two queues, also those for which they have no room, of two frames that take
/// turns.
struct RasterCounts {
    cl_uint triangles[2];
    cl_uint blocks[2];
    cl_uint note;  ///< the user's: see Triangles::note()
};
CELLIST_STRUCT(RasterCounts, triangles, blocks, note);

/// Where a sample of a pixel lies: 1/16 pixel from its centre.
struct SampleOffset {
    int x, y;
};

/// The samples of a pixel, of which there are 1, 2, 4 or 8.
[[nodiscard]] inline std::span<const SampleOffset> sample_offsets(int samples) {
    static constexpr SampleOffset one[]{RASTER_OFFSETS_1}, two[]{RASTER_OFFSETS_2},
        four[]{RASTER_OFFSETS_4}, eight[]{RASTER_OFFSETS_8};
    if (samples == 8) return eight;
    if (samples == 4) return four;
    if (samples == 2) return two;
    return one;
}

}  // namespace raster
