// SPDX-License-Identifier: MIT
// Stochastic transparency (Enderton, Sintorn, Shirley, Luebke, I3D 2010), with its depth-based
// accumulation and its correction of opacity. A fragment of opacity alpha hides what is behind it
// in each of OIT_TRIALS trials with that probability; its colour counts for the part of the trials
// in which nothing hides it. What is random is decided by a hash of the pixel, the fragment and the
// trial, so the image is the same every time. Of each sample:
//   depths  OIT_TRIALS: least depth that hides, as bits of floats
//   sums    5: of colour and weight, and of absorbance

#ifdef OIT_HIDE
#define OIT_TARGET volatile global uint* depths
#define OIT_TARGET_PASS depths
#else
#define OIT_TARGET global const uint *depths, volatile global long *sums
#define OIT_TARGET_PASS depths, sums
#endif

// An integer hash of good avalanche (Wellons 2018).
static inline uint oit_hash(uint x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    for (int s = 0; s < OIT_SAMPLES; ++s) {
        if (!(fragment->coverage >> s & 1)) continue;
        const size_t sample = location->pixel * OIT_SAMPLES + s;
#ifdef OIT_HIDE
        const uint seed = oit_hash((uint)sample + oit_hash(location->order));
        for (uint trial = 0; trial < OIT_TRIALS; ++trial) {
            const float chance = (float)(oit_hash(seed + trial) >> 8) * 0x1p-24f;
            if (chance < fragment->alpha)
                atomic_min(&depths[sample * OIT_TRIALS + trial], as_uint(fragment->depth));
        }
#else
        uint seen = 0;
        for (uint trial = 0; trial < OIT_TRIALS; ++trial)
            if (as_uint(fragment->depth) <= depths[sample * OIT_TRIALS + trial]) ++seen;
        volatile global long* own = sums + 5 * sample;
        oit_accumulate_colour(own, frame, fragment->colour,
                              fragment->alpha * (float)seen / (float)OIT_TRIALS);
        oit_accumulate_absorbance(&own[4], oit_absorbance(fragment->alpha));
#endif
    }
}
