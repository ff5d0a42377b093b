// SPDX-License-Identifier: MIT
// One frame, with all layers in float, and what of it is how certain.
//
// Reads lists sorted by key, of fragments that are in front of the opaque surfaces or so little
// behind them that float does not tell. Writes the image, and for each pixel
//   uncertainty  xyz: how far the sRGB-encoded image is from the truth at most, where depths tell
//                the order of all layers; w: by how much more where they do not
// metrics: see metrics.clh. The bounds are the largest errors of
//   0        the image, apart from what depends on an order that float depths do not tell
//   1        the image
//   2 ...    OIT_FORMATS: of all layers in each packed format, as 0; infinite where none is known
//   then     OIT_LAYER_COUNTS: of so many nearest layers, in float
//   then     OIT_EPSILONS: of an end where no more than that part of the light passes
// Then come as maxima: the light that passes behind so many layers, opacity, minus opacity, layers.
// And as sums: pixels in which a depth of float, of 24 and of 16 bits does not tell an order that
// matters; fragments; pixels by their number of layers, bin i for 2^(i - 1) and more, and bin 0 for
// none.

// The depths of nodes: float, 24 and 16 bits.
#define OIT_DEPTHS_OF_NODES 3

#define OIT_FIRST_FORMAT 2
#define OIT_FIRST_LAYERS (OIT_FIRST_FORMAT + OIT_FORMATS)
#define OIT_CUTS (OIT_LAYER_COUNT + OIT_EPSILON_COUNT)
#define OIT_BOUNDS (OIT_FIRST_LAYERS + OIT_CUTS)
// After the bounds, as maxima and as sums.
#define OIT_LIGHT_BEHIND OIT_BOUNDS
#define OIT_OPACITY (OIT_LIGHT_BEHIND + OIT_LAYER_COUNT)
#define OIT_LONGEST (OIT_OPACITY + 2)
#define OIT_UNRESOLVED OIT_BOUNDS
#define OIT_FRAGMENTS (OIT_UNRESOLVED + OIT_DEPTHS_OF_NODES)
#define OIT_FIRST_BIN (OIT_FRAGMENTS + 1)

constant uint oit_layer_counts[] = {OIT_LAYER_COUNTS};
constant float oit_epsilons[] = {OIT_EPSILONS};

// ---- layers whose depths are closer than depths resolve -----------------------------------------

// So many layers in front of one are looked at one by one.
#define OIT_WINDOW 4

static inline float oit_resolution(const OitResolution* resolution, int kind, float depth) {
    return resolution->constant_part[kind] +
           depth * (resolution->linear_part[kind] + depth * resolution->quadratic_part[kind]);
}

// A layer, and the light in front of it.
typedef struct {
    OitBlendState before;
    OitFragment fragment;
} OitLayer;

typedef struct {
    OitLayer layers[OIT_WINDOW];  // the i-th layer of a pixel at i % OIT_WINDOW
    uint count;
    // Of the last layer that is no longer among them: its depth, and the light that gets there.
    float lost_depth, lost_reaches;
    float effect[OIT_DEPTHS_OF_NODES];  // linear, of all orders that depths do not tell
} OitOrder;

static inline float oit_blend_difference(const OitBlend* a, const OitBlend* b, float brightest,
                                         float distance) {
    float difference = oit_brightest(fabs(a->colour - b->colour)) +
                       oit_most(fabs(a->transmittance - b->transmittance)) * brightest;
#ifdef OIT_ABSORBS
    const float3 extinction = fabs(a->extinction - b->extinction);
    difference += oit_most(a->transmittance) * brightest *
                  (1.0f - exp(-oit_brightest(extinction) * distance));
#endif
    return difference;
}

// How far apart two layers are in a sample, of which the first is in front at the mean of its
// samples.
#ifdef OIT_DEPTH_RANGE
static inline float oit_reach(const OitFragment* fragment) {
    return fabs(fragment->slope_x) + fabs(fragment->slope_y);
}
// In any sample.
static inline float oit_least_depth(const OitFragment* fragment) {
    return fragment->depth / (1.0f + oit_reach(fragment));
}
static inline float oit_greatest_depth(const OitFragment* fragment) {
    return fragment->depth / fmax(1.0f - oit_reach(fragment), 0x1p-20f);
}

static inline float oit_depth_at(const OitFragment* fragment, int sample) {
    const float2 move = oit_offsets[sample] - oit_mean_offset(fragment->coverage);
    return fragment->depth / (1.0f + fragment->slope_x * move.x + fragment->slope_y * move.y);
}

static inline float oit_gap(const OitFragment* front, const OitFragment* back, int sample) {
    const float a = oit_depth_at(front, sample), b = oit_depth_at(back, sample);
    // Nodes have slopes as halves.
    return fabs(a - b) - 0x1p-10f * (fabs(a - front->depth) + fabs(b - back->depth));
}
#else
#define oit_least_depth(fragment) ((fragment)->depth)
#define oit_greatest_depth(fragment) ((fragment)->depth)
#define oit_gap(front, back, sample) ((back)->depth - (front)->depth)
#endif

// Adds how much the image changes at most if two layers change places, in the samples in which they
// are closer than depths resolve. brightest: of the light behind. distance: through what is behind.
static inline void oit_exchange(OitOrder* order, const OitPixel* pixel, const OitLayer* front,
                                const OitFragment* fragment, float brightest, float distance,
                                const float* close) {
    OitFragment back = *fragment;
    back.depth = front->fragment.depth;
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i) {
        if (!oit_covers(pixel, &front->fragment, i) || !oit_covers(pixel, &back, i)) continue;
        const float gap = oit_gap(&front->fragment, fragment, pixel->first_sample + i);
        if (gap > fmax(close[0], fmax(close[1], close[2]))) continue;
        OitBlend ordered = front->before.of[i], swapped = ordered;
        oit_blend(&ordered, &front->fragment, pixel->ray_length);
        oit_blend(&ordered, &back, pixel->ray_length);
        oit_blend(&swapped, &back, pixel->ray_length);
        oit_blend(&swapped, &front->fragment, pixel->ray_length);
        const float effect = oit_blend_difference(&ordered, &swapped, brightest, distance) /
                             (float)OIT_BLENDED_SAMPLES;
        for (int kind = 0; kind < OIT_DEPTHS_OF_NODES; ++kind)
            if (gap <= close[kind]) order->effect[kind] += effect;
    }
}

// The next layer of a pixel.
static inline void oit_next_layer(OitOrder* order, const OitPixel* pixel,
                                  const OitResolution* resolution, const OitBlendState* before,
                                  const OitFragment* fragment, float brightest, float last_depth) {
    const float distance = fmax(last_depth - fragment->depth, 0.0f) * pixel->ray_length;
    float close[OIT_DEPTHS_OF_NODES];
    for (int kind = 0; kind < OIT_DEPTHS_OF_NODES; ++kind)
        close[kind] = oit_resolution(resolution, kind, fragment->depth);
    for (uint back = 1; back <= min(order->count, (uint)OIT_WINDOW); ++back) {
        const OitLayer* front = &order->layers[(order->count - back) % OIT_WINDOW];
        oit_exchange(order, pixel, front, fragment, brightest, distance, close);
    }
    // With more than that, all light that gets there may change.
    for (int kind = 0; kind < OIT_DEPTHS_OF_NODES; ++kind)
        if (oit_least_depth(fragment) - order->lost_depth <= close[kind])
            order->effect[kind] += order->lost_reaches * brightest;

    OitLayer* location = &order->layers[order->count % OIT_WINDOW];
    if (order->count >= OIT_WINDOW &&
        oit_greatest_depth(&location->fragment) >= order->lost_depth) {
        order->lost_depth = oit_greatest_depth(&location->fragment);
        order->lost_reaches = 0.0f;
        for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i)
            order->lost_reaches =
                fmax(order->lost_reaches, oit_most(location->before.of[i].transmittance));
    }
    location->before = *before;
    location->fragment = *fragment;
    ++order->count;
}

// ---- errors -------------------------------------------------------------------------------------

// How far the encoding of a value is from that of another which is off by `error` at most.
static inline float oit_encoded_error(float value, float error) {
    const float at = oit_srgb(value);
    return fmax(at - oit_srgb(value - error), oit_srgb(value + error) - at);
}

static inline float3 oit_encoded_error3(float3 value, float3 error) {
    return (float3)(oit_encoded_error(value.x, error.x), oit_encoded_error(value.y, error.y),
                    oit_encoded_error(value.z, error.z));
}

// What the packed formats do to colours and opacities, linear, summed over the layers.
typedef struct {
    float3 colour[OIT_FORMATS];
    float alpha[OIT_FORMATS];
} OitPacking;

// Half a step of the square root, on either side.
static inline float3 oit_root_error(float3 colour, float most, float3 steps) {
    const float3 step = 0.5f / steps * (1.0f + 0x1p-10f);
    return most * step * (2.0f * sqrt(colour / most) + step);
}

static inline void oit_add_packing(OitPacking* packing, const OitFrame* frame,
                                   const OitFragment* fragment, float reaches, float brightest) {
    const float most = frame->colour_max, weight = reaches * fragment->alpha;
    const float3 eight = oit_root_error(fragment->colour, most, (float3)(255.0f));
    packing->colour[0] += weight * fmax(fragment->colour * 0x1p-11f, (float3)(0x1p-25f));
    packing->colour[1] += weight * eight;
    packing->colour[2] += weight * eight;
    packing->colour[3] +=
        weight * oit_root_error(fragment->colour, most, (float3)(31.0f, 63.0f, 31.0f));
#ifdef OIT_ALPHA_WORD
    for (int i = 0; i < OIT_FORMATS; ++i)
        packing->alpha[i] += (i == 0 ? 0x1p-12f : 0.502f / 255.0f) * brightest;
#endif
}

// Bounds are known for what covers and what adds.
#define OIT_HAS_PACKING_BOUND ((OIT_BLENDS & ~(1u << OIT_OVER | 1u << OIT_ADDITIVE)) == 0u)

// How far the linear image is from the truth at most, where the order of its layers is right.
// shares: the sum of the parts of their colours that layers add. u is 2^-24; see docs/numerics.md.
static inline float3 oit_rounding(const OitFrame* frame, float3 seen, uint layers, float shares,
                                  float brightest) {
    // The shading of each layer by its share, and what is behind. Where surfaces cover, shares sum
    // to 1.
    float3 error = OIT_SHADING_ERROR * frame->colour_max * fmax(shares, 1.0f);
    // Blending, (3 n + 2) u of sums without a negative term; the mean of samples rounds up to 8
    // times more.
    error += seen * (0x1p-20f + 0x1p-22f * layers);
#ifdef OIT_HAS_OPACITIES
    // Opacities of the corners are interpolated as depths are, to 8 u.
    error += 0x1p-21f * brightest * layers;
#endif
#ifdef OIT_ABSORBS
    // Distances are differences of two depths, each off by 8 u of itself: 256 u, where extinction
    // times depth is 16 at most.
    error += 0x1p-16f * seen * layers;
#endif
    return error;
}

// ---- the survey ---------------------------------------------------------------------------------

// The samples of a fragment that are in front of the opaque surfaces; `close` gets those of which
// float does not tell.
static inline uint oit_surely_visible(OIT_SCREEN, const OitPixel* pixel,
                                      const OitResolution* resolution, const OitFragment* fragment,
                                      uint* close) {
    *close = 0;
    uint sure = fragment->coverage;
#ifdef OIT_HAS_OPAQUE
    const float reach = oit_resolution(resolution, 0, fragment->depth);
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i) {
        float depth;
        (void)oit_behind(OIT_SCREEN_PASS, pixel, i, &depth);
        if (fabs(depth - fragment->depth) <= reach) *close |= 1u << i & sure;
        if (!(fragment->depth < depth)) sure &= ~(1u << i);
    }
#endif
    return sure;
}

static inline float3 oit_mean_seen(OIT_SCREEN, const OitPixel* pixel,
                                   const OitBlendState* blended) {
    OitBlendState copy = *blended;
    return oit_sum_of_samples(OIT_SCREEN_PASS, pixel, &copy) / (float)OIT_BLENDED_SAMPLES;
}

static inline float oit_passes(const OitBlendState* blended) {
    float most = 0.0f;
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i)
        most = fmax(most, oit_most(blended->of[i].transmittance));
    return most;
}

// The brightest light that can come from behind a layer, and where the last surface is.
static inline float oit_light_from_behind(CELLIST_LISTS(OIT_NODE, fragments), OIT_SCREEN,
                                          const OitPixel* pixel, uint cell, float* last_depth) {
    float brightest = 0.0f, added = 0.0f;
    *last_depth = 0.0f;
    for (int i = 0; i < OIT_BLENDED_SAMPLES; ++i) {
        float depth;
        brightest = fmax(brightest, oit_brightest(oit_behind(OIT_SCREEN_PASS, pixel, i, &depth)));
        if (depth < INFINITY) *last_depth = fmax(*last_depth, depth);
    }
    cellist_for_each(fragments, cell, node) {
        const OitFragment fragment = oit_unpack(&pixel->frame, cellist_get(fragments, node));
        *last_depth = fmax(*last_depth, fragment.depth);
        if (oit_blends(&fragment, OIT_ADDITIVE) || oit_blends(&fragment, OIT_USER))
            added += fragment.alpha * oit_brightest(fragment.colour);
        else if (oit_blends(&fragment, OIT_OVER))
            brightest = fmax(brightest, oit_brightest(fragment.colour));
    }
    return brightest + added;
}

// What a pixel shows after so many layers, and after so little light: see OIT_CUTS.
typedef struct {
    float3 seen[OIT_CUTS];
    float passes[OIT_LAYER_COUNT];  // the light that passes behind so many layers
    uint reached;                   // a bit for each cut
} OitCuts;

// Keeps what the pixel shows in front of its next layer, for the cuts that end there.
static inline void oit_cut(OitCuts* cuts, OIT_SCREEN, const OitPixel* pixel,
                           const OitBlendState* blended, uint layers, float passes) {
    for (int i = 0; i < OIT_CUTS; ++i) {
        if (cuts->reached >> i & 1) continue;
        if (i < OIT_LAYER_COUNT ? layers != oit_layer_counts[i]
                                : passes > oit_epsilons[i - OIT_LAYER_COUNT])
            continue;
        cuts->reached |= 1u << i;
        cuts->seen[i] = oit_mean_seen(OIT_SCREEN_PASS, pixel, blended);
        if (i < OIT_LAYER_COUNT) cuts->passes[i] = passes;
    }
}

kernel void oit_survey(CELLIST_LISTS(OIT_NODE, fragments), const OitResolution resolution,
                       global float4* uncertainty, global float* metrics, OIT_SCREEN) {
    local float shared[OIT_GROUP * OIT_METRICS];
    OitMetrics own = oit_no_metrics();
    OitPixel pixel;
    if (oit_pixel(OIT_SCREEN_PASS, &pixel)) {
        const uint cell = cellist_cell3(fragments, pixel.x, pixel.y, pixel.eye);

        float last_depth;
        const float brightest = oit_light_from_behind(CELLIST_PASS(fragments), OIT_SCREEN_PASS,
                                                      &pixel, cell, &last_depth);

        OitBlendState blended = oit_blend_state();
        OitOrder order;
        order.count = 0;
        order.lost_depth = -INFINITY;
        for (int kind = 0; kind < OIT_DEPTHS_OF_NODES; ++kind) order.effect[kind] = 0.0f;
        OitPacking packing;
        for (int i = 0; i < OIT_FORMATS; ++i) {
            packing.colour[i] = 0.0f;
            packing.alpha[i] = 0.0f;
        }
        OitCuts cuts;
        cuts.reached = 0;
        for (int i = 0; i < OIT_LAYER_COUNT; ++i) cuts.passes[i] = 0.0f;
        uint layers = 0;
        float shares = 0.0f;
        float hidden = 0.0f;  // by opaque surfaces, or not
        cellist_for_each(fragments, cell, node) {
            OitFragment fragment = oit_unpack(&pixel.frame, cellist_get(fragments, node));
            uint close;
            const uint sure =
                oit_surely_visible(OIT_SCREEN_PASS, &pixel, &resolution, &fragment, &close);
            if (close != 0) {
                OitBlendState with = blended;
                fragment.coverage = close;
                oit_add(&with, &pixel, &fragment);
                hidden += oit_brightest(fabs(oit_mean_seen(OIT_SCREEN_PASS, &pixel, &with) -
                                             oit_mean_seen(OIT_SCREEN_PASS, &pixel, &blended)));
            }
            if (sure == 0) continue;
            fragment.coverage = sure;

            const float passes = oit_passes(&blended);
            oit_cut(&cuts, OIT_SCREEN_PASS, &pixel, &blended, layers, passes);
            oit_next_layer(&order, &pixel, &resolution, &blended, &fragment, brightest, last_depth);
            oit_add_packing(&packing, &pixel.frame, &fragment, passes, brightest);
            shares += passes * fragment.alpha;
            oit_add(&blended, &pixel, &fragment);
            ++layers;
            own.most[OIT_OPACITY] = fmax(own.most[OIT_OPACITY], fragment.alpha);
            own.most[OIT_OPACITY + 1] = fmax(own.most[OIT_OPACITY + 1], -fragment.alpha);
        }

        const float3 seen = oit_mean_seen(OIT_SCREEN_PASS, &pixel, &blended);
        const float3 encoded = oit_srgb3(seen);
        const float3 off = oit_rounding(&pixel.frame, seen, layers, shares, brightest);
        const float3 certain = oit_encoded_error3(seen, off) + OIT_ENCODING_ERROR;
        const float float_order = order.effect[0] + hidden;
        float4 uncertain = (float4)(certain, 0.0f);
        if (float_order > 0.0f)
            uncertain.w = oit_brightest(oit_encoded_error3(seen, off + float_order) - certain +
                                        OIT_ENCODING_ERROR);
        image[pixel.pixel] = (float4)(seen, 1.0f);
        uncertainty[pixel.pixel] = uncertain;

        oit_add_bound(&own, 0, certain);
        oit_add_bound(&own, 1, certain + uncertain.w);
        for (int i = 0; i < OIT_FORMATS; ++i) {
            // 24 and 16 bits of depth tell less than float.
            const float further = order.effect[max(i - 1, 0)] - order.effect[0];
            const float3 error = OIT_HAS_PACKING_BOUND
                                     ? packing.colour[i] + packing.alpha[i] + further + off
                                     : (float3)(INFINITY);
            oit_add_bound(&own, OIT_FIRST_FORMAT + i,
                          oit_encoded_error3(seen, error) + OIT_ENCODING_ERROR);
        }
        for (int i = 0; i < OIT_CUTS; ++i) {
            const float3 error =
                cuts.reached >> i & 1 ? fabs(oit_srgb3(cuts.seen[i]) - encoded) : 0.0f;
            oit_add_bound(&own, OIT_FIRST_LAYERS + i, error + certain);
        }
        for (int i = 0; i < OIT_LAYER_COUNT; ++i) own.most[OIT_LIGHT_BEHIND + i] = cuts.passes[i];
        own.most[OIT_LONGEST] = (float)layers;
        own.sum[OIT_UNRESOLVED] = float_order > 0.0f;
        for (int kind = 1; kind < OIT_DEPTHS_OF_NODES; ++kind)
            own.sum[OIT_UNRESOLVED + kind] = order.effect[kind] + hidden > 0.0f;
        own.sum[OIT_FRAGMENTS] = (float)layers;
        own.sum[OIT_FIRST_BIN + min(32 - (int)clz(layers), OIT_BINS - 1)] = 1.0f;
    }
    oit_write_metrics(shared, metrics, &own);
}
