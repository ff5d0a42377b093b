// SPDX-License-Identifier: MIT
// Pass: the least depth of the opaque surfaces in each sample, as the bits of a float. Depths are
// positive, so their bits are ordered as they are. Filled with the bits of infinity before.
#define RASTER_TARGET volatile global uint* depth_bits
#define RASTER_TARGET_PASS depth_bits

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const size_t pixel = oit_pixel_index(view, instance->eye, covered->x, covered->y);
    for (int s = 0; s < OIT_SAMPLES; ++s)
        if (covered->coverage >> s & 1)
            atomic_min(&depth_bits[pixel * OIT_SAMPLES + s], as_uint(covered->depth));
}
