// SPDX-License-Identifier: MIT
// Pass: the nearest triangle at one time, at the same place in each pixel. keys[pixel]: see
// keys.clh.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

#define SWEEP_TARGET volatile global ulong *keys, float still_time, float offset_x, float offset_y
#define SWEEP_TARGET_PASS keys, still_time, offset_x, offset_y
#define SWEEP_REACH 0.5f
#define SWEEP_TIME still_time

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline uint2 sweep_parts(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                                int y) {
    return (uint2)(0, 1);
}

static inline void sweep_part(SWEEP_TARGET, const View view, const MovingTriangle* t, int x, int y,
                              uint part) {
    keep_nearest(keys + y * view.width + x, view, t,
                 pixel_centre(view, x, y) + (float2)(offset_x, offset_y), 0.0f);
}
