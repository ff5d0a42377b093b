// Pass: the nearest triangle at each sample of a pixel, at the sample's own place and time
// (stochastic rasterisation, McGuire, Enderton, Shirley, Luebke 2010). keys[sample * pixels + pixel]
// holds its depth, and its number in the lower half.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

#define SWEEP_TARGET volatile global ulong *keys, const Sampling sampling
#define SWEEP_TARGET_PASS keys, sampling
#define SWEEP_REACH 0.5f

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const float2 centre = pixel_centre(view, x, y);
    const uint2 range = touching_samples(t, centre, 0.5f, sampling);
    const uint pixel = (uint)(y * view.width + x), pixels = (uint)(view.width * view.height);
    for (uint sample = range.x; sample < range.y; ++sample)
        keep_nearest(keys + (size_t)(sample - sampling.first) * pixels + pixel, view, t,
                     centre + sample_offset(pixel, sample),
                     sample_time(pixel, sample, sampling.samples, 0));
}
