// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/cellist.hpp>

namespace motion {

/// A camera or a light and its image, as kernels take them. Image coordinates count pixels from the
/// centre of the image, x to the right and y down.
struct View {
    /// Rows that take a position (x, y, z, 1) to x * w, y * w, w, and depth along the axis. w is
    /// the depth in a perspective view, and 1 in a parallel view.
    cl_float4 row_x, row_y, row_w, row_depth;
    cl_float near_depth;  ///< nothing nearer than this is drawn or casts a shadow
    cl_float pixel;       ///< the size of a pixel at depth 1, or everywhere in a parallel view
    cl_int is_parallel;
    cl_int width, height;
};
CELLIST_STRUCT(View, row_x, row_y, row_w, row_depth, near_depth, pixel, is_parallel, width, height);

/// A vertex in a view, at both ends of the exposure: x * w, y * w, w, depth. NaN where it cannot be
/// drawn.
struct MovingVertex {
    cl_float4 begin, end;
};
CELLIST_STRUCT(MovingVertex, begin, end);

/// A rectangle of the pixels that a triangle sweeps over.
struct SweepTile {
    cl_uint triangle;
    /// The number of the tile in its triangle, row by row; plus 65536 * the shift of its size in
    /// sweep_divide().
    cl_uint place;
};
CELLIST_STRUCT(SweepTile, triangle, place);

/// A triangle covers the centre of a texel from `begin` to before `end`.
struct VisibleRange {
    cl_float begin, end;
    cl_uint triangle;
};
CELLIST_STRUCT(VisibleRange, begin, end, triangle);

/// The light's ray through the centre of a texel meets a facet of the prism that a moving triangle
/// sweeps out, at this depth and time.
struct PrismFragment {
    cl_float depth, time;
    cl_uint triangle;
};
CELLIST_STRUCT(PrismFragment, depth, time, triangle);

/// Two fragments of a prism: the triangle covers the centre of a texel from `begin` to `end`.
struct DepthTimeRange {
    cl_float begin, end;
    cl_float depth_begin, depth_end;
    cl_uint triangle;
};
CELLIST_STRUCT(DepthTimeRange, begin, end, depth_begin, depth_end, triangle);

/// The depth of one or more neighbouring triangles at the centre of a texel, linear in time.
struct DepthPiece {
    cl_float begin, end;
    cl_float depth_begin, depth_end;
};
CELLIST_STRUCT(DepthPiece, begin, end, depth_begin, depth_end);

/// What a sample of the camera sees, as the receiver of a shadow.
struct Receiver {
    cl_uint triangle;  ///< or 0xFFFFFFFF where it sees nothing; highest bit: in shadow
    cl_uint texel;     ///< of the shadow map, or 0xFFFFFFFF where no shadow test is needed
    cl_float limit;    ///< what is nearer to the light than this blocks it
    cl_float light;    ///< the part of the light's intensity that it reflects if nothing blocks it
};
CELLIST_STRUCT(Receiver, triangle, texel, limit, light);

/// The samples of a pixel.
struct Sampling {
    cl_uint samples;       ///< of each pixel
    cl_uint first, count;  ///< the first sample and the number of samples in this batch
};
CELLIST_STRUCT(Sampling, samples, first, count);

/// What surfaces look like.
struct Shading {
    cl_float4 light;      ///< position of a spot light, 1; or direction to a parallel light, 0
    cl_float4 eye;        ///< position, and 1
    cl_float4 intensity;  ///< linear RGB; of a spot light at distance 1
    cl_float4 ambient;    ///< linear RGB
    cl_float4 background;
    cl_float bias;  ///< of shadow tests, in texels
};
CELLIST_STRUCT(Shading, light, eye, intensity, ambient, background, bias);

}  // namespace motion
