// Blends each pixel's fragments front to back, with the transmittance carried along, over the
// opaque colour or the background. image: 4 floats a pixel, linear.
//
// The lists are sorted by depth. With OIT_NEAREST=K they need not be, and the K nearest fragments
// of each are blended; OIT_LAYERS=K stops after the first K of a sorted list.

static inline void oit_blend(const Look* look, const Fragment* fragment, float3* colour,
                             float* transmittance) {
    const float3 own = (float3)(fragment->red, fragment->green, fragment->blue);
    *colour += *transmittance * look->alpha * own;
    *transmittance *= 1.0f - look->alpha;
}

kernel void oit_resolve(CELLIST_LISTS(Fragment, fragments), const View kernel_view,
                        const Look kernel_look,
#ifdef OIT_OPAQUE
                        global const uint* depth_bits, global const float4* opaque_colour,
#endif
                        global float4* image) {
    const int x = get_global_id(0), y = get_global_id(1);
    if (x >= kernel_view.width || y >= kernel_view.height) return;
    const View view = kernel_view;
    const Look look = kernel_look;
    const size_t pixel = (size_t)y * view.width + x;
    const uint cell = cellist_cell2(fragments, x, y);

    float3 colour = (float3)(0.0f);
    float transmittance = 1.0f;
#ifdef OIT_NEAREST
    Fragment nearest[OIT_NEAREST];
    const uint found = cellist_nearest(fragments, cell, depth, OIT_NEAREST, nearest);
    for (uint i = 0; i < found; ++i) oit_blend(&look, &nearest[i], &colour, &transmittance);
#else
    uint layer = 0;
    cellist_for_each(fragments, cell, node) {
#ifdef OIT_LAYERS
        if (layer++ == OIT_LAYERS) break;
#endif
        const Fragment fragment = cellist_get(fragments, node);
        oit_blend(&look, &fragment, &colour, &transmittance);
    }
#endif

    float3 behind = oit_background(&look, &view, y);
#ifdef OIT_OPAQUE
    if (depth_bits[pixel] != as_uint(INFINITY)) behind = opaque_colour[pixel].xyz;
#endif
    image[pixel] = (float4)(colour + transmittance * behind, 1.0f);
}
