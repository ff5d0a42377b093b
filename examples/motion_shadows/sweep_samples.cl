// Pass: the nearest depth at each sample of a texel, at the sample's own time: a time-dependent
// shadow map (Akenine-Moeller, Munkberg, Hasselgren: "Stochastic rasterization using time-continuous
// triangles", 2007; McGuire, Enderton, Shirley, Luebke: "Real-time stochastic rasterization on
// conventional GPU architectures", 2010). depths[sample * texels + texel]
#define SWEEP_TARGET                                                                               \
    volatile global uint *depths, global const float *farthest, const Sampling sampling
#define SWEEP_TARGET_PASS depths, farthest, sampling
#define SWEEP_REACH 0.0f

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const uint texel = (uint)(y * view.width + x);
    if (!(triangle_least_depth(t) < farthest[texel])) return;
    const float2 place = pixel_centre(view, x, y);
    const uint2 range = touching_samples(t, place, 0x1p-7f, sampling);
    for (uint sample = range.x; sample < range.y; ++sample) {
        float depth;
        if (!triangle_covers(t, place, sample_time(texel, sample, sampling.samples, 1), &depth) ||
            !(depth >= view.near_depth))
            continue;
        volatile global uint* nearest =
            depths + (size_t)(sample - sampling.first) * (uint)(view.width * view.height) + texel;
        // Positive floats are ordered as their bits are; depths only fall.
        if (as_uint(depth) < *nearest) atomic_min(nearest, as_uint(depth));
    }
}
