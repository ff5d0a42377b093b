// SPDX-License-Identifier: MIT
// Bucket depth peeling: each pass takes the nearest layer of each of OIT_BUCKETS ranges of depth.
// Behind a range with more than one layer the order of the others is not known, so what is behind
// it is taken again by the next passes, which divide what is left anew.
//   begin    a pixel's key that everything in front of has been blended; OIT_LAST_KEY at the end
//   range    least and greatest depth of what is left, as bits of floats
//   buckets  least key of each range of depth
//   counts   fragments in each
//   nodes    the layers that were taken
//   state    what has been blended
// The passes: with OIT_FIND_RANGE; then alternately with OIT_FIND_KEYS and with neither, which
// takes the layers.

static inline uint oit_bucket(float depth, float least, float greatest) {
    const float part = (depth - least) / fmax(greatest - least, 1e-30f);
    return clamp((int)(part * (float)OIT_BUCKETS), 0, OIT_BUCKETS - 1);
}

#ifdef OIT_STORES
#define OIT_TARGET                                                                                 \
    global const ulong *begin, volatile global uint *range, volatile global ulong *buckets,        \
        volatile global uint *counts, global uint *nodes
#define OIT_TARGET_PASS begin, range, buckets, counts, nodes

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    const ulong key = oit_peeling_key(location, fragment);
#ifdef OIT_FIND_RANGE
    atomic_min(&range[2 * location->pixel], as_uint(fragment->depth));
    atomic_max(&range[2 * location->pixel + 1], as_uint(fragment->depth));
#else
    if (key < begin[location->pixel]) return;
    const size_t bucket = location->pixel * OIT_BUCKETS +
                          oit_bucket(fragment->depth, as_float(range[2 * location->pixel]),
                                     as_float(range[2 * location->pixel + 1]));
#ifdef OIT_FIND_KEYS
    atom_min(&buckets[bucket], key);
    atomic_inc(&counts[bucket]);
#else
    if (key == buckets[bucket]) oit_keep(nodes, bucket, frame, fragment);
#endif
#endif
}

#else

// Blends the layers that were taken, up to the first of a range that has more. `left` is set where
// there is one.
kernel void oit_peel_buckets(global ulong* begin, global uint* range, global ulong* buckets,
                             global uint* counts, global const uint* nodes, global float* state,
                             global uint* left, uint first, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    OitBlendState blended = oit_blend_state();
    if (!first) {
        if (begin[pixel.pixel] == OIT_LAST_KEY) return;
        blended = oit_load(state, &pixel);
    }
    ulong then = OIT_LAST_KEY;
    for (uint i = 0; i < OIT_BUCKETS; ++i) {
        const size_t bucket = pixel.pixel * OIT_BUCKETS + i;
        if (counts[bucket] == 0) continue;
        if (then == OIT_LAST_KEY && !oit_done(&blended, &pixel)) {
            const OitFragment fragment = oit_kept(nodes, bucket, &pixel.frame);
            oit_add(&blended, &pixel, &fragment);
            if (counts[bucket] > 1) {
                then = buckets[bucket] + 1;
                range[2 * pixel.pixel] = as_uint(oit_depth_of_peeling_key(buckets[bucket]));
                *left = 1;
            }
        }
        counts[bucket] = 0;
        buckets[bucket] = OIT_LAST_KEY;
    }
    begin[pixel.pixel] = then;
    oit_save(state, &pixel, &blended);
}
#endif
