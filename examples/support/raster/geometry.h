// The arithmetic that defines the snapped geometry: projection, clipping and snapping to sub-
// pixels.
//
// Compiled by C++ and by OpenCL C, so that host and device get the same bits: every product that is
// added to something is an explicit fma, in a fixed order, and nothing else can be contracted.
// What follows from the snapped geometry (coverage, depth, shading) is not here: the device and the
// reference each have their own.
//
// Screen coordinates count 1/256 pixel, x to the right and y down, from the upper left corner of
// the image. Clip coordinates (x, y, w) are relative to the centre of the image: x / w and y / w
// are sub-pixels, w is the depth along the viewing direction.
#ifndef RASTER_GEOMETRY_H
#define RASTER_GEOMETRY_H

#ifdef __OPENCL_VERSION__
#pragma OPENCL FP_CONTRACT OFF
#define RASTER_FMA(a, b, c) fma(a, b, c)
#define RASTER_RINT(a) rint(a)
#endif

#define RASTER_SUBPIXEL_BITS 8
#define RASTER_SUBPIXELS 256
// Largest side of an image in pixels.
#define RASTER_SIDE_MAX 16384
// Triangles are clipped to this many sub-pixels to each side of the image's centre: twice the
// largest image. Differences of snapped coordinates then take 25 bits, edge functions 51.
#define RASTER_GUARD 4194304.0f

#define RASTER_PLANES 5
#define RASTER_POLYGON_MAX 8
#define RASTER_PIECES_MAX 6

// A vertex in clip coordinates; share[j] is the part of the triangle's corner j in it.
typedef struct {
    float x, y, w;
    float share[3];
} RasterClipVertex;

// What clipping leaves of a triangle: a convex polygon.
typedef struct {
    RasterClipVertex vertex[RASTER_POLYGON_MAX];
    int count;
} RasterPolygon;

static inline float raster_row(const float* row, float x, float y, float z) {
    return RASTER_FMA(row[0], x, RASTER_FMA(row[1], y, RASTER_FMA(row[2], z, row[3])));
}

// At least 0 on the inner side of a plane: 0 near, 1 right, 2 left, 3 bottom, 4 top.
static inline float raster_plane(const View* view, int plane, float x, float y, float w) {
    if (plane == 0) return w - view->near_depth;
    if (plane == 1) return RASTER_FMA(RASTER_GUARD, w, -x);
    if (plane == 2) return RASTER_FMA(RASTER_GUARD, w, x);
    if (plane == 3) return RASTER_FMA(RASTER_GUARD, w, -y);
    return RASTER_FMA(RASTER_GUARD, w, y);
}

// One bit for each plane that the point is outside of.
static inline int raster_outside(const View* view, float x, float y, float w) {
    int bits = 0;
    for (int plane = 0; plane < RASTER_PLANES; ++plane)
        if (!(raster_plane(view, plane, x, y, w) >= 0.0f)) bits |= 1 << plane;
    return bits;
}

// Sub-pixels from the image's edge for a coordinate that is inside of the guard band.
static inline int raster_snap(float coordinate, float w, int side) {
    return (int)RASTER_RINT(coordinate / w) + side * (RASTER_SUBPIXELS / 2);
}

static inline RasterVertex raster_project(const View* view, const RasterInstance* instance, float x,
                                          float y, float z) {
    const float clip_x = raster_row(instance->row_x, x, y, z);
    const float clip_y = raster_row(instance->row_y, x, y, z);
    RasterVertex vertex;
    vertex.w = raster_row(instance->row_w, x, y, z);
    vertex.outside = raster_outside(view, clip_x, clip_y, vertex.w);
    vertex.x = 0;
    vertex.y = 0;
    if (vertex.outside == 0) {
        vertex.x = raster_snap(clip_x, vertex.w, view->width);
        vertex.y = raster_snap(clip_y, vertex.w, view->height);
    }
    return vertex;
}

// Corner j of a triangle, before clipping.
static inline RasterClipVertex raster_corner(const RasterInstance* instance, int j, float x,
                                             float y, float z) {
    RasterClipVertex corner;
    corner.x = raster_row(instance->row_x, x, y, z);
    corner.y = raster_row(instance->row_y, x, y, z);
    corner.w = raster_row(instance->row_w, x, y, z);
    for (int k = 0; k < 3; ++k) corner.share[k] = k == j ? 1.0f : 0.0f;
    return corner;
}

// Where the edge from a (inside, distance da) to b (outside, db) meets a plane. Computed from the
// inner end in every triangle, so that triangles that share the edge agree.
static inline RasterClipVertex raster_meet(const View* view, int plane, RasterClipVertex a,
                                           float da, RasterClipVertex b, float db) {
    const float t = da / (da - db);
    RasterClipVertex v;
    v.x = RASTER_FMA(t, b.x - a.x, a.x);
    v.y = RASTER_FMA(t, b.y - a.y, a.y);
    v.w = plane == 0 ? view->near_depth : RASTER_FMA(t, b.w - a.w, a.w);
    for (int k = 0; k < 3; ++k) v.share[k] = RASTER_FMA(t, b.share[k] - a.share[k], a.share[k]);
    const float guard = RASTER_GUARD * v.w;
    if (plane == 1) v.x = guard;
    if (plane == 2) v.x = -guard;
    if (plane == 3) v.y = guard;
    if (plane == 4) v.y = -guard;
    return v;
}

// Clips a triangle against the near plane and the guard band. The polygon has 0 or 3 to 8 vertices.
static inline void raster_clip(const View* view, RasterPolygon* polygon) {
    for (int plane = 0; plane < RASTER_PLANES; ++plane) {
        const RasterPolygon in = *polygon;
        polygon->count = 0;
        for (int i = 0; i < in.count; ++i) {
            const RasterClipVertex a = in.vertex[i];
            const RasterClipVertex b = in.vertex[i + 1 < in.count ? i + 1 : 0];
            const float da = raster_plane(view, plane, a.x, a.y, a.w);
            const float db = raster_plane(view, plane, b.x, b.y, b.w);
            if (da >= 0.0f && polygon->count < RASTER_POLYGON_MAX)
                polygon->vertex[polygon->count++] = a;
            if ((da >= 0.0f) != (db >= 0.0f) && polygon->count < RASTER_POLYGON_MAX)
                polygon->vertex[polygon->count++] = da >= 0.0f
                                                        ? raster_meet(view, plane, a, da, b, db)
                                                        : raster_meet(view, plane, b, db, a, da);
        }
        if (polygon->count < 3) polygon->count = 0;
    }
}

#endif
