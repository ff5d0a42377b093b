// SPDX-License-Identifier: MIT
// Peels the nearest layers of each pixel and keeps them for rays through a lens (see lens.cl).
//   current, next  as in peeling.cl
//   kept           the nodes of the nearest layer of each pixel, then of the second, and so on
//   counts         the number of layers kept for each pixel

#ifdef OIT_STORES
// layer_begin: where the nodes of this pass's layer begin.
#define OIT_TARGET                                                                                 \
    global const ulong *current, volatile global ulong *next, global uint *kept,                   \
        const uint layer_begin
#define OIT_TARGET_PASS current, next, kept, layer_begin

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    const ulong key = oit_peeling_key(location, fragment);
    const ulong now = current[location->pixel];
    if (key == now)
        oit_keep(kept, layer_begin + location->pixel, frame, fragment);
    else if (key > now)
        atom_min(&next[location->pixel], key);
}

#else

// Goes on to the next layer.
kernel void oit_advance(global ulong* current, global ulong* next, global uint* counts,
                        OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const ulong now = current[pixel.pixel];
    if (now == OIT_LAST_KEY) return;
    if (now != OIT_FIRST_KEY) ++counts[pixel.pixel];
    current[pixel.pixel] = next[pixel.pixel];
    next[pixel.pixel] = OIT_LAST_KEY;
}

#define OIT_NODES global const uint *kept, global const uint *counts, const uint pixels
#define OIT_NODES_PASS kept, counts, pixels
#define OIT_FOR_EACH_NODE(n)                                                                       \
    for (uint n = pixel.pixel, end_of_##n = n + pixels * counts[n]; n < end_of_##n; n += pixels)
#define OIT_NODE_AT(n) (((global const struct OIT_NODE*)kept)[n])
#endif
