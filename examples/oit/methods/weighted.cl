// SPDX-License-Identifier: MIT
// Weighted blended transparency (McGuire, Bavoil: "Weighted Blended Order-Independent
// Transparency", JCGT 2013, equations 7 and 10): the mean of all colours, weighted by opacity and
// nearness, in place of their order. The weights are those of the paper, divided by the greatest.
// sums: 5 for each sample: of colour and weight, and of absorbance.

#define OIT_TARGET volatile global long* sums
#define OIT_TARGET_PASS sums

static inline float oit_weight(float unit_depth) {
    const float near = 1.0f - unit_depth;
    return fmax(1e-2f / 3e3f, near * near * near);
}

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    const float weight = fragment->alpha * oit_weight(oit_unit_depth(frame, fragment->depth));
    for (int s = 0; s < OIT_SAMPLES; ++s) {
        if (!(fragment->coverage >> s & 1)) continue;
        volatile global long* own = sums + 5 * (location->pixel * OIT_SAMPLES + s);
        oit_accumulate_colour(own, frame, fragment->colour, weight);
        oit_accumulate_absorbance(&own[4], oit_absorbance(fragment->alpha));
    }
}
