// SPDX-License-Identifier: MIT
// The depth and the colour of the opaque surface in each sample, from the piece that owns it.
// Samples without a surface get no colour. With OIT_NEAREST_OWNERS, owners are those of
// opaque_nearest.cl, and are reset for the next frame. Otherwise the depths are there already.
#ifdef OIT_NEAREST_OWNERS
#define OIT_OWNER ulong
#else
#define OIT_OWNER const uint
#endif

static inline float3 oit_shade_piece(const OitFrame* frame, global const Material* materials,
                                     global const float* normals, global const float* tints,
                                     RASTER_SCENE, uint piece, int x, int y) {
    RasterTriangle t;
    raster_load_piece(RASTER_SCENE_PASS, piece, &t);
    global const RasterInstance* instance = instances + t.instance;
    const Material material = materials[instance->tag];
    const View view = views[instance->eye];
    if (material.paint == OIT_FLOOR) return oit_shade_floor(&frame->lighting, &view, x, y);
    raster_invert(&t);
    RasterFragment covered;
    raster_fragment_at(&t, x, y, &covered);
    return oit_shade_surface(&frame->lighting, oit_tint(&material, &covered, tints), material.gloss,
                             oit_normal(instance, &covered, normals), covered.front,
                             oit_ray(&view, x, y));
}

kernel void oit_shade_opaque(global OIT_OWNER* owners, global uint* depth_bits,
                             global float4* colour, const OitFrame kernel_frame,
                             global const Material* materials, global const float* normals,
                             global const float* tints, RASTER_SCENE) {
    const int x = get_global_id(0), y = get_global_id(1), eye = get_global_id(2);
    const View view = views[eye];
    if (x >= view.width || y >= view.height) return;
    const OitFrame frame = kernel_frame;
    const size_t pixel = oit_pixel_index(&view, eye, x, y);
    uint shaded_piece = CELLIST_NONE;
    float3 shaded = 0.0f;
    for (int s = 0; s < OIT_SAMPLES; ++s) {
        const size_t sample = pixel * OIT_SAMPLES + s;
        const uint piece = (uint)owners[sample];
#ifdef OIT_NEAREST_OWNERS
        depth_bits[sample] = owners[sample] >> 32;
        owners[sample] = OIT_NO_OWNER;
#endif
        if (piece == CELLIST_NONE) continue;
        if (piece != shaded_piece)
            shaded =
                oit_shade_piece(&frame, materials, normals, tints, RASTER_SCENE_PASS, piece, x, y);
        shaded_piece = piece;
        colour[sample] = (float4)(shaded, 1.0f);
    }
}
