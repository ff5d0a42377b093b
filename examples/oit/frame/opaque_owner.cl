// SPDX-License-Identifier: MIT
// Pass: of the pieces of opaque triangles at the least depth of a sample, the first. Filled with
// the greatest number before.
#define RASTER_TARGET volatile global uint *owners, global const uint *depth_bits
#define RASTER_TARGET_PASS owners, depth_bits

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const size_t pixel = oit_pixel_index(view, instance->eye, covered->x, covered->y);
    for (int s = 0; s < OIT_SAMPLES; ++s)
        if (covered->coverage >> s & 1 &&
            as_uint(covered->depth) == depth_bits[pixel * OIT_SAMPLES + s])
            atomic_min(&owners[pixel * OIT_SAMPLES + s], piece);
}
