// Pass: the times at which triangles cover the centres of texels.
#define SWEEP_TARGET CELLIST_LISTS(VisibleRange, ranges), global const uchar *wanted
#define SWEEP_TARGET_PASS CELLIST_PASS(ranges), wanted
#define SWEEP_REACH 0.0f

static inline void sweep_refuse(SWEEP_TARGET) {
    const VisibleRange none = {0.0f, 0.0f, 0};
    cellist_insert(ranges, CELLIST_NONE, none);
}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const uint texel = (uint)(y * view.width + x);
    if (!wanted[texel]) return;
    VisibleTimes times;
    if (!visible_begin(&times, t, pixel_centre(view, x, y))) return;
    float2 time;
    while (visible_next(&times, &time)) {
        const VisibleRange range = {time.x, time.y, t->number};
        cellist_insert(ranges, texel, range);
    }
}
