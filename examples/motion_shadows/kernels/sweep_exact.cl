// SPDX-License-Identifier: MIT
// Pass: the times at which triangles cover the centres of texels.
#define SWEEP_TARGET CELLIST_LISTS(VisibleRange, ranges), global const float* farthest
#define SWEEP_TARGET_PASS CELLIST_PASS(ranges), farthest
#define SWEEP_REACH 0.0f
#ifdef SWEEP_GROUP
#define SWEEP_SHARES
#endif

static inline void sweep_refuse(SWEEP_TARGET) {
    const VisibleRange none = {0.0f, 0.0f, 0};
    cellist_insert(ranges, CELLIST_NONE, none);
}

static inline uint2 sweep_parts(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                                int y) {
    if (!(triangle_least_depth(t) < farthest[y * view.width + x])) return (uint2)(0);
    const float2 times = touching_times(t, pixel_centre(view, x, y), 0x1p-7f);
    return (uint2)(0, times.x <= times.y);
}

static inline void sweep_part(SWEEP_TARGET, const View view, const MovingTriangle* t, int x, int y,
                              uint part) {
    VisibleTimes times;
    if (!visible_begin(&times, t, pixel_centre(view, x, y))) return;
    float2 time;
    while (visible_next(&times, &time)) {
        const VisibleRange range = {time.x, time.y, t->number};
        cellist_insert(ranges, (uint)(y * view.width + x), range);
    }
}
