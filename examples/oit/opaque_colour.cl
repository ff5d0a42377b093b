// Pass: the colour of the opaque surface that opaque_depth.cl found nearest in each pixel. Opaque
// triangles do not overlap at equal depth; where they did, the last one to write would stay.
#define RASTER_TARGET global const uint *depth_bits, global float4 *colour, const Look kernel_look
#define RASTER_TARGET_PASS depth_bits, colour, kernel_look

static inline void raster_emit(RASTER_TARGET, const View* view, const RasterSample* sample) {
    const size_t pixel = (size_t)sample->y * view->width + sample->x;
    if (as_uint(sample->depth) != depth_bits[pixel]) return;
    const Look look = kernel_look;
    colour[pixel] = (float4)(oit_shade_floor(&look, view, sample->x, sample->y), 1.0f);
}
