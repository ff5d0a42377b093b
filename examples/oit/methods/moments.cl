// SPDX-License-Identifier: MIT
// Moment-based transparency (Muenstermann, Krumpen, Klein, Peters: "Moment-Based Order-Independent
// Transparency", I3D 2018), with four power moments. The first pass sums the absorbances of the
// fragments of a sample, each times powers of depth; the second finds from these sums how much
// light reaches each fragment. A mean weighted by this light does not change if all weights of a
// sample are multiplied by one factor, so they are relative to that of the nearest fragment: the
// light that reaches a surface of opacity 1 underflows.
//   moments  5 for each sample: of absorbance times depth to the power of 0 ... 4
//   nearest  the least depth of each sample, as bits of floats
//   sums     5 for each sample: of colour and weight, and of absorbance

#ifdef OIT_MOMENTS
#define OIT_TARGET volatile global long *moments, volatile global uint *nearest
#define OIT_TARGET_PASS moments, nearest
#else
#define OIT_TARGET                                                                                 \
    global const long *moments, global const uint *nearest, volatile global long *sums
#define OIT_TARGET_PASS moments, nearest, sums
#endif

// The moments of a surface of opacity 1, whose absorbance is infinite, are those of this
// absorbance: as in the code that the authors published.
#define OIT_MOMENT_ABSORBANCE_MAX 10.0f

// Depth from -1 to 1, evenly by its logarithm.
static inline float oit_moment_depth(const OitFrame* frame, float depth) {
    const float part =
        log(depth / frame->least_depth) / log(frame->greatest_depth / frame->least_depth);
    return 2.0f * clamp(part, 0.0f, 1.0f) - 1.0f;
}

#ifndef OIT_MOMENTS
// Towards moments of which an answer is sure to exist (Muenstermann et al., section 3.1).
#define OIT_MOMENT_BIAS 5e-7f
// The part of the absorbance at the depth itself that counts as in front of it.
#define OIT_OVERESTIMATION 0.25f

// Above this absorbance the weights are relative to that of the nearest fragment: up to it, they
// are 2^-15 at least.
#define OIT_ABSORBANCE_OF_SMALL_WEIGHTS 10.0f
// The least weight, relative to that: where all others round to 0, the mean is one by opacity.
#define OIT_LEAST_WEIGHT 0x1p-24f

// The absorbance in front of the depth z: the least distribution of absorbance with these moments
// lies at z and at two other depths, the roots of a quadratic; what is in front is summed (section
// 3.2, and Peters, Klein: "Moment Shadow Mapping", I3D 2015, algorithm 3).
static inline float oit_in_front(global const long* moments, float z) {
    const float b0 = oit_sum(&moments[0]);
    if (!(b0 > 1e-6f)) return 0.0f;
    const float b1 = mix(oit_sum(&moments[1]) / b0, 0.0f, OIT_MOMENT_BIAS);
    const float b2 = mix(oit_sum(&moments[2]) / b0, 0.375f, OIT_MOMENT_BIAS);
    const float b3 = mix(oit_sum(&moments[3]) / b0, 0.0f, OIT_MOMENT_BIAS);
    const float b4 = mix(oit_sum(&moments[4]) / b0, 0.375f, OIT_MOMENT_BIAS);

    // Cholesky factors of the Hankel matrix, and its inverse times (1, z, z^2).
    const float l21_d11 = fma(-b1, b2, b3);
    const float d11 = fmax(fma(-b1, b1, b2), 1e-12f);
    const float l21 = l21_d11 / d11;
    const float d22 = fmax(fma(-l21_d11, l21, fma(-b2, b2, b4)), 1e-12f);
    float c1 = z - b1;
    float c2 = z * z - b2 - l21 * c1;
    c1 /= d11;
    c2 /= d22;
    c1 -= l21 * c2;
    const float c0 = 1.0f - c1 * b1 - c2 * b2;
    if (fabs(c2) < 1e-20f) return OIT_OVERESTIMATION * b0;

    const float p = c1 / c2, q = c0 / c2;
    const float root = sqrt(fmax(0.25f * p * p - q, 0.0f));
    const float z1 = -0.5f * p - root, z2 = -0.5f * p + root;
    // The quadratic through the weights at z, z1 and z2, and its mean by the moments.
    const float f0 = OIT_OVERESTIMATION, f1 = z1 < z ? 1.0f : 0.0f, f2 = z2 < z ? 1.0f : 0.0f;
    const float f01 = (f1 - f0) / (z1 - z);
    const float f12 = (f2 - f1) / (z2 - z1);
    const float f012 = (f12 - f01) / (z2 - z);
    const float p1 = f01 - f012 * z1;
    const float part = f0 - p1 * z + (p1 - f012 * z) * b1 + f012 * b2;
    return b0 * (isfinite(part) ? clamp(part, 0.0f, 1.0f) : OIT_OVERESTIMATION);
}

// The light that reaches a fragment, as far as the mean needs it.
static inline float oit_weight(const OitFrame* frame, global const long* moments, uint nearest,
                               float z) {
    float in_front = oit_in_front(moments, z);
    if (oit_sum(&moments[0]) > OIT_ABSORBANCE_OF_SMALL_WEIGHTS)
        in_front -= oit_in_front(moments, oit_moment_depth(frame, as_float(nearest)));
    return fmax(exp(-fmax(in_front, 0.0f)), OIT_LEAST_WEIGHT);
}
#endif

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    const float z = oit_moment_depth(frame, fragment->depth);
    for (int s = 0; s < OIT_SAMPLES; ++s) {
        if (!(fragment->coverage >> s & 1)) continue;
        const size_t sample = location->pixel * OIT_SAMPLES + s;
#ifdef OIT_MOMENTS
        if (fragment->alpha > 0.0f) atomic_min(&nearest[sample], as_uint(fragment->depth));
        float power = fmin(oit_absorbance(fragment->alpha), OIT_MOMENT_ABSORBANCE_MAX);
        for (int i = 0; i < 5; ++i) {
            oit_accumulate_absorbance(&moments[5 * sample + i], power);
            power *= z;
        }
#else
        volatile global long* own = sums + 5 * sample;
        const float weight = oit_weight(frame, moments + 5 * sample, nearest[sample], z);
        oit_accumulate_colour(own, frame, fragment->colour, fragment->alpha * weight);
        oit_accumulate_absorbance(&own[4], oit_absorbance(fragment->alpha));
#endif
    }
}
