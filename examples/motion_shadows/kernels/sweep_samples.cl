// SPDX-License-Identifier: MIT
// Pass: the nearest depth at each sample of a texel, at the sample's own time: a time-dependent
// shadow map (Akenine-Moeller, Munkberg, Hasselgren: "Stochastic rasterization using
// time-continuous triangles", 2007; McGuire, Enderton, Shirley, Luebke: "Real-time stochastic
// rasterization on conventional GPU architectures", 2010). depths[sample * texels + texel].
#define SWEEP_TARGET                                                                               \
    volatile global uint *depths, global const float *farthest, const Sampling sampling
#define SWEEP_TARGET_PASS depths, farthest, sampling
#define SWEEP_REACH 0.0f

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline uint2 sweep_parts(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                                int y) {
    if (!(triangle_least_depth(t) < farthest[y * view.width + x])) return (uint2)(0);
    return touching_samples(t, pixel_centre(view, x, y), 0x1p-7f, sampling);
}

static inline void sweep_part(SWEEP_TARGET, const View view, const MovingTriangle* t, int x, int y,
                              uint part) {
    const uint texel = (uint)(y * view.width + x);
    float depth;
    if (!triangle_covers(t, pixel_centre(view, x, y),
                         sample_time(texel, sampling.first + part, sampling.samples, 1), &depth) ||
        !(depth >= view.near_depth))
        return;
    volatile global uint* nearest =
        depths + (size_t)part * (uint)(view.width * view.height) + texel;
    // Positive floats are ordered as their bits are. Depths only fall, so a stale depth does no
    // harm.
    if (as_uint(depth) < *nearest) atomic_min(nearest, as_uint(depth));
}
