// SPDX-License-Identifier: MIT
// Dual depth peeling: each pass takes the nearest and the farthest layer that are left. A pixel has
// two of each: what is in front, then what is behind.
//   current  keys of the layers that this pass takes; OIT_FIRST_KEY and OIT_LAST_KEY at the start
//   next     least and greatest key between them
//   nodes    the layers that were taken
//   state    what has been blended
// At the end, the keys in front are OIT_LAST_KEY.

#ifdef OIT_STORES
#define OIT_TARGET global const ulong *current, volatile global ulong *next, global uint *nodes
#define OIT_TARGET_PASS current, next, nodes

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    const ulong key = oit_peeling_key(location, fragment);
    const size_t front = 2 * location->pixel, back = front + 1;
    if (key == current[front]) {
        oit_keep(nodes, front, frame, fragment);
    } else if (key == current[back]) {
        oit_keep(nodes, back, frame, fragment);
    } else if (key > current[front] && key < current[back]) {
        atom_min(&next[front], key);
        atom_max(&next[back], key);
    }
}

#else

// Puts a fragment in front of what is blended already. A fragment turns the light behind it into
// colour + transmittance * light, and so do several.
static inline void oit_put_in_front(OitBlendState* blended, const OitPixel* pixel,
                                    const OitFragment* fragment) {
    OitBlendState alone = oit_blend_state();
    oit_add(&alone, pixel, fragment);
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i) {
        blended->of[i].colour =
            alone.of[i].colour + alone.of[i].transmittance * blended->of[i].colour;
        blended->of[i].transmittance *= alone.of[i].transmittance;
    }
}

// Blends the layers that were taken, and goes on to the next. `left` is set where there are any.
kernel void oit_peel(global ulong* current, global ulong* next, global const uint* nodes,
                     global float* front_state, global float* back_state, global uint* left,
                     OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const size_t front = 2 * pixel.pixel, back = front + 1;
    const ulong near = current[front], far = current[back];
    if (near == OIT_LAST_KEY) return;
    OitBlendState front_blended = oit_blend_state(), back_blended = oit_blend_state();
    if (near != OIT_FIRST_KEY) {
        front_blended = oit_load(front_state, &pixel);
        back_blended = oit_load(back_state, &pixel);
        const OitFragment nearest = oit_kept(nodes, front, &pixel.frame);
        oit_add(&front_blended, &pixel, &nearest);
        if (far != near) {
            const OitFragment farthest = oit_kept(nodes, back, &pixel.frame);
            oit_put_in_front(&back_blended, &pixel, &farthest);
        }
    }
    oit_save(front_state, &pixel, &front_blended);
    oit_save(back_state, &pixel, &back_blended);
    current[front] = next[front];
    current[back] = next[back];
    if (next[front] != OIT_LAST_KEY) *left = 1;
    next[front] = OIT_LAST_KEY;
    next[back] = OIT_FIRST_KEY;
}

kernel void oit_finish_dual_peeling(global const float* front_state, global const float* back_state,
                                    OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    OitBlendState blended = oit_load(front_state, &pixel);
    const OitBlendState behind = oit_load(back_state, &pixel);
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i) {
        blended.of[i].colour += blended.of[i].transmittance * behind.of[i].colour;
        blended.of[i].transmittance *= behind.of[i].transmittance;
    }
    oit_write(OIT_SCREEN_PASS, &pixel, &blended);
}
#endif
