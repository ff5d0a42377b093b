// Pass: the least depth of the opaque surfaces in each pixel, as the bits of a float. Depths are
// positive, so their bits are ordered as they are. Filled with the bits of infinity before.
#define RASTER_TARGET volatile global uint* depth_bits
#define RASTER_TARGET_PASS depth_bits

static inline void raster_emit(RASTER_TARGET, const View* view, const RasterSample* sample) {
    atomic_min(&depth_bits[(size_t)sample->y * view->width + sample->x], as_uint(sample->depth));
}
