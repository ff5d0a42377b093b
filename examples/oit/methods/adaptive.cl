// SPDX-License-Identifier: MIT
// Adaptive transparency (Salvi, Montgomery, Lefohn, HPG 2011): how much light reaches a depth is
// kept as a step function of at most OIT_STEPS steps; where there are more, the one goes whose loss
// changes the area under the function least. Fragments come from lists sorted by key, so that the
// image does not depend on the order in which they were inserted. Fragments at one depth make one
// step, and are blended in their order, as if they were one fragment.

// Behind depth[i], the part passes[i] of the light comes through; ascending.
typedef struct {
    float depth[OIT_STEPS + 1];
    float passes[OIT_STEPS + 1];
    int count;
} OitSteps;

// How much light comes from the depth to the eye, past all that is nearer.
static inline float oit_reaches(const OitSteps* steps, float depth) {
    float passes = 1.0f;
    for (int i = 0; i < steps->count; ++i)
        if (steps->depth[i] < depth) passes = steps->passes[i];
    return passes;
}

// A step that goes gives its part to the one in front of it.
static inline void oit_limit(OitSteps* steps) {
    if (steps->count <= OIT_STEPS) return;
    int least = 1;
    float least_area = INFINITY;
    for (int i = 1; i < steps->count; ++i) {
        const float area =
            (steps->depth[i] - steps->depth[i - 1]) * (steps->passes[i - 1] - steps->passes[i]);
        if (area < least_area) {
            least = i;
            least_area = area;
        }
    }
    steps->passes[least - 1] = steps->passes[least];
    for (int i = least; i + 1 < steps->count; ++i) {
        steps->depth[i] = steps->depth[i + 1];
        steps->passes[i] = steps->passes[i + 1];
    }
    --steps->count;
}

// A fragment behind all so far, or at the depth of the last. That step is whole before one has to
// go.
static inline void oit_step(OitSteps* steps, const OitFragment* fragment) {
    float passes = 1.0f;
    if (steps->count > 0) {
        const int last = steps->count - 1;
        passes = steps->passes[last];
        if (steps->depth[last] == fragment->depth) {
            steps->passes[last] = passes * (1.0f - fragment->alpha);
            return;
        }
        oit_limit(steps);
    }
    steps->depth[steps->count] = fragment->depth;
    steps->passes[steps->count++] = passes * (1.0f - fragment->alpha);
}

kernel void oit_resolve_adaptive(CELLIST_LISTS(OIT_NODE, fragments), OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const uint cell = cellist_cell3(fragments, pixel.x, pixel.y, pixel.eye);
    OitBlendState blended = oit_blend_state();
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i) {
        OitSteps steps;
        steps.count = 0;
        cellist_for_each(fragments, cell, node) {
            const OitFragment fragment = oit_unpack(&pixel.frame, cellist_get(fragments, node));
            if (oit_covers(&pixel, &fragment, i)) oit_step(&steps, &fragment);
        }
        oit_limit(&steps);
        float depth = -INFINITY, reaches = 1.0f;
        cellist_for_each(fragments, cell, node) {
            const OitFragment fragment = oit_unpack(&pixel.frame, cellist_get(fragments, node));
            if (!oit_covers(&pixel, &fragment, i)) continue;
            if (fragment.depth > depth) reaches = oit_reaches(&steps, fragment.depth);
            depth = fragment.depth;
            blended.of[i].colour += reaches * fragment.alpha * fragment.colour;
            reaches *= 1.0f - fragment.alpha;
        }
        if (steps.count > 0) blended.of[i].transmittance = steps.passes[steps.count - 1];
    }
    oit_write(OIT_SCREEN_PASS, &pixel, &blended);
}
