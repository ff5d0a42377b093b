// SPDX-License-Identifier: MIT
// Pass: the least key of each pixel.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

#define RASTER_TARGET SURFACES_TARGET
#define RASTER_TARGET_PASS SURFACES_TARGET_PASS

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const ulong key =
        fragment_key(&placed_meshes[instance->tag], covered, mesh_positions, piece, from);
    // Keys only fall, so a stale one does no harm.
    volatile global ulong* least = &keys[covered->y * view->width + covered->x];
    if (key < *least) atom_min(least, key);
}
