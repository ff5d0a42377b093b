// Pass: the least key of each pixel.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

#define RASTER_TARGET SURFACES_TARGET
#define RASTER_TARGET_PASS SURFACES_TARGET_PASS

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const float3 position =
        fragment_position(placed_meshes[instance->tag], covered, mesh_positions);
    const ulong key = fragment_key(position, covered, piece, from);
    atom_min((volatile global ulong*)&keys[covered->y * view->width + covered->x], key);
}
