// Pass: the nearest triangle at the place of each pixel, at one time. `keys` holds its depth, and
// its number + 1 in the lower half, or the largest key where nothing is.
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable

#define SWEEP_TARGET volatile global ulong *keys, float still_time, float offset_x, float offset_y
#define SWEEP_TARGET_PASS keys, still_time, offset_x, offset_y
#define SWEEP_REACH 0.5f
#define SWEEP_TIME still_time

static inline void sweep_refuse(SWEEP_TARGET) {}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const float2 place = pixel_centre(view, x, y) + (float2)(offset_x, offset_y);
    uint sides;
    float3 depths;
    const float3 weights = triangle_weights(t, place, 0.0f, &sides, &depths);
    if (sides != 0 && sides != 7) return;
    const float depth = triangle_depth(t, place, 0.0f);
    if (!(depth >= view.near_depth)) return;
    const ulong key = (ulong)as_uint(depth) << 32 | t->number;
    volatile global ulong* least = keys + y * view.width + x;
    // Keys only fall, so a stale one does no harm.
    if (key < *least) atom_min(least, key);
}
