// Pass: the nearest depth at each sample of a texel, at the sample's own time: a time-dependent
// shadow map (Akenine-Moeller, Munkberg, Hasselgren: "Stochastic rasterization using time-continuous
// triangles", 2007; McGuire, Enderton, Shirley, Luebke: "Real-time stochastic rasterization on
// conventional GPU architectures", 2010). depths[sample * texels + texel]
#define SWEEP_TARGET                                                                               \
    volatile global uint *depths, global const uchar *wanted, const Sampling sampling
#define SWEEP_TARGET_PASS depths, wanted, sampling
#define SWEEP_REACH 0.0f

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const uint texel = (uint)(y * view.width + x);
    if (!wanted[texel]) return;
    const float2 place = pixel_centre(view, x, y);
    const float2 times = touching_times(t, place, 0x1p-7f);
    if (times.x > times.y) return;
    const uint end = min((uint)(times.y * (float)sampling.samples) + 1u,
                         sampling.first + sampling.count);
    const uint begin = max((uint)(times.x * (float)sampling.samples), sampling.first);
    for (uint sample = begin; sample < end; ++sample) {
        const float time = sample_time(texel, sample, sampling.samples, 1);
        uint sides;
        float3 vertex_depths;
        triangle_weights(t, place, time, &sides, &vertex_depths);
        if (sides != 0 && sides != 7) continue;
        const float depth = triangle_depth(t, place, time);
        if (!(depth >= view.near_depth)) continue;
        volatile global uint* nearest =
            depths + (size_t)(sample - sampling.first) * (uint)(view.width * view.height) + texel;
        if (as_uint(depth) < *nearest) atomic_min(nearest, as_uint(depth));
    }
}
