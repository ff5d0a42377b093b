#pragma once

#include <cmath>

#include <cellist/cellist.hpp>

namespace raster {

/// A pinhole camera and an image, as the kernels take them.
struct View {
    /// Rows that take a position (x, y, z, 1) to clip coordinates: see geometry.h.
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

/// A projected vertex: sub-pixels, depth, and a bit for each clipping plane that it is outside of.
/// x and y are 0 where it is outside of any.
struct RasterVertex {
    cl_int x;
    cl_int y;
    cl_float w;
    cl_int outside;
};
CELLIST_STRUCT(RasterVertex, x, y, w, outside);

#define RASTER_FMA(a, b, c) std::fma(a, b, c)
#define RASTER_RINT(a) std::rint(a)
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#endif
#include "raster/geometry.h"
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#undef RASTER_FMA
#undef RASTER_RINT

}  // namespace raster
