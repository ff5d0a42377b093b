// Pass: the times at which triangles cover the centres of texels.
#define SWEEP_TARGET CELLIST_LISTS(VisibleRange, ranges), global const float *farthest
#define SWEEP_TARGET_PASS CELLIST_PASS(ranges), farthest
#define SWEEP_REACH 0.0f

static inline void sweep_refuse(SWEEP_TARGET) {
    const VisibleRange none = {0.0f, 0.0f, 0};
    cellist_insert(ranges, CELLIST_NONE, none);
}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const uint texel = (uint)(y * view.width + x);
    const float limit = farthest[texel];
    if (!(triangle_least_depth(t) < limit)) return;
    const float2 place = pixel_centre(view, x, y);
    const float2 near = touching_times(t, place, 0x1p-7f);
    VisibleTimes times;
    if (near.x > near.y || !visible_begin(&times, t, place)) return;
    float2 time;
    while (visible_next(&times, &time)) {
        const VisibleRange range = {time.x, time.y, t->number};
        cellist_insert(ranges, texel, range);
    }
}
