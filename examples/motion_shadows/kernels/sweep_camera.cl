// SPDX-License-Identifier: MIT
// Pass: the nearest triangle at each sample of a pixel, at the sample's own place and time
// (stochastic rasterisation: McGuire, Enderton, Shirley, Luebke, 2010).
// keys[sample * pixels + pixel]: see keys.clh.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

#define SWEEP_TARGET volatile global ulong *keys, const Sampling sampling
#define SWEEP_TARGET_PASS keys, sampling
#define SWEEP_REACH 0.5f

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline uint2 sweep_parts(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                                int y) {
    return touching_samples(t, pixel_centre(view, x, y), 0.5f, sampling);
}

static inline void sweep_part(SWEEP_TARGET, const View view, const MovingTriangle* t, int x, int y,
                              uint part) {
    const uint pixel = (uint)(y * view.width + x), sample = sampling.first + part;
    keep_nearest(keys + (size_t)part * (uint)(view.width * view.height) + pixel, view, t,
                 pixel_centre(view, x, y) + sample_offset(pixel, sample),
                 sample_time(pixel, sample, sampling.samples, 0));
}
