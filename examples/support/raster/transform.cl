// Projection, and snapping to sub-pixels.
//
// Where vertices snap to is part of the definition of a picture, which the reference of cellist-oit
// follows with code of its own. So each operation is rounded to float: every product that is added
// to something is an explicit fma, in a fixed order, and nothing else is contracted.
#pragma OPENCL FP_CONTRACT OFF

#define RASTER_PLANES 5

static inline float raster_row(const float* row, float x, float y, float z) {
    return fma(row[0], x, fma(row[1], y, fma(row[2], z, row[3])));
}

// At least 0 on the inner side of a plane: 0 near, 1 right, 2 left, 3 bottom, 4 top.
static inline float raster_plane(const View* view, int plane, float x, float y, float w) {
    if (plane == 0) return w - view->near_depth;
    if (plane == 1) return fma(RASTER_GUARD, w, -x);
    if (plane == 2) return fma(RASTER_GUARD, w, x);
    if (plane == 3) return fma(RASTER_GUARD, w, -y);
    return fma(RASTER_GUARD, w, y);
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
    return (int)rint(coordinate / w) + side * (RASTER_SUBPIXELS / 2);
}

// Projects the vertices of all instances, a work-group for each batch of them. positions: 3 floats
// a vertex.
kernel void raster_transform(global const View* views, global const RasterInstance* instances,
                             global const RasterBatch* batches, global const float* positions,
                             global RasterVertex* vertices) {
    const RasterBatch batch = batches[get_group_id(0)];
    const uint i = batch.first + get_local_id(0);
    if (i >= batch.end) return;
    const float3 p = vload3(i, positions);
    const RasterInstance instance = instances[batch.instance];
    const View view = views[instance.eye];
    const float x = raster_row(instance.row_x, p.x, p.y, p.z);
    const float y = raster_row(instance.row_y, p.x, p.y, p.z);
    RasterVertex vertex;
    vertex.w = raster_row(instance.row_w, p.x, p.y, p.z);
    vertex.outside = raster_outside(&view, x, y, vertex.w);
    vertex.x = vertex.outside == 0 ? raster_snap(x, vertex.w, view.width) : 0;
    vertex.y = vertex.outside == 0 ? raster_snap(y, vertex.w, view.height) : 0;
    vertices[i + instance.vertex_offset] = vertex;
}
