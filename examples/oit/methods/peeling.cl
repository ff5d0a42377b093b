// SPDX-License-Identifier: MIT
// Depth peeling. A pixel has
//   current  key of the layer that this pass takes; OIT_FIRST_KEY at the start, OIT_LAST_KEY at
//            the end
//   next     least key behind it
//   nodes    the layer that was taken
//   state    what has been blended

#ifdef OIT_STORES
#define OIT_TARGET global const ulong *current, volatile global ulong *next, global uint *nodes
#define OIT_TARGET_PASS current, next, nodes

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    const ulong key = oit_peeling_key(location, fragment);
    const ulong now = current[location->pixel];
    if (key == now)
        oit_keep(nodes, location->pixel, frame, fragment);
    else if (key > now)
        atom_min(&next[location->pixel], key);
}

#else

// Blends the layer that was taken, and goes on to the next. `left` is set where there is one.
kernel void oit_peel(global ulong* current, global ulong* next, global const uint* nodes,
                     global float* state, global uint* left, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const ulong now = current[pixel.pixel];
    if (now == OIT_LAST_KEY) return;
    OitBlendState blended;
    if (now == OIT_FIRST_KEY) {
        blended = oit_blend_state();
    } else {
        blended = oit_load(state, &pixel);
        const OitFragment fragment = oit_kept(nodes, pixel.pixel, &pixel.frame);
        oit_add(&blended, &pixel, &fragment);
    }
    oit_save(state, &pixel, &blended);
    const ulong then = oit_done(&blended, &pixel) ? OIT_LAST_KEY : next[pixel.pixel];
    current[pixel.pixel] = then;
    next[pixel.pixel] = OIT_LAST_KEY;
    if (then != OIT_LAST_KEY) *left = 1;
}
#endif
