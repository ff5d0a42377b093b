// SPDX-License-Identifier: MIT
// Pass: the nearest opaque surface in each sample, as the bits of its depth and, in the low word,
// its piece. Depths are positive, so their bits are ordered as they are. Of pieces at one depth,
// the first counts. Filled with the bits of infinity and the greatest number before.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable
#define RASTER_TARGET volatile global ulong* nearest
#define RASTER_TARGET_PASS nearest

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const size_t pixel = oit_pixel_index(view, instance->eye, covered->x, covered->y);
    const ulong here = (ulong)as_uint(covered->depth) << 32 | piece;
    for (int s = 0; s < OIT_SAMPLES; ++s)
        if (covered->coverage >> s & 1) atom_min(&nearest[pixel * OIT_SAMPLES + s], here);
}
