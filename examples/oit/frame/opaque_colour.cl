// SPDX-License-Identifier: MIT
// Pass: the colour of each sample's opaque surface, from the piece that owns it.
#define RASTER_TARGET                                                                              \
    global const uint *owners, global const uint *depth_bits, global float4 *colour,               \
        const OitFrame kernel_frame, global const Material *materials,                             \
        global const float *normals, global const float *tints
#define RASTER_TARGET_PASS owners, depth_bits, colour, kernel_frame, materials, normals, tints

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const size_t pixel = oit_pixel_index(view, instance->eye, covered->x, covered->y);
    uint owned = 0;
    for (int s = 0; s < OIT_SAMPLES; ++s)
        if (covered->coverage >> s & 1 && owners[pixel * OIT_SAMPLES + s] == piece &&
            depth_bits[pixel * OIT_SAMPLES + s] == as_uint(covered->depth))
            owned |= 1u << s;
    if (owned == 0) return;
    const OitFrame frame = kernel_frame;
    const Material material = materials[instance->tag];
    float3 shaded;
    if (material.paint == OIT_FLOOR) {
        shaded = oit_shade_floor(&frame.lighting, view, covered->x, covered->y);
    } else {
        const float3 normal = oit_normal(instance, covered, normals);
        shaded =
            oit_shade_surface(&frame.lighting, oit_tint(&material, covered, tints), material.gloss,
                              normal, covered->front, oit_ray(view, covered->x, covered->y));
    }
    for (int s = 0; s < OIT_SAMPLES; ++s)
        if (owned >> s & 1) colour[pixel * OIT_SAMPLES + s] = (float4)(shaded, 1.0f);
}
