// Pass: the triangles that may cover a place of a pixel at some time.
#define SWEEP_TARGET CELLIST_LISTS(Candidate, candidates)
#define SWEEP_TARGET_PASS CELLIST_PASS(candidates)
#define SWEEP_REACH 0.5f

static inline void sweep_refuse(SWEEP_TARGET) {
    const Candidate none = {0, 0};
    cellist_insert(candidates, CELLIST_NONE, none);
}

static inline void sweep_pixel(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                               int y) {
    const float2 times = touching_times(t, pixel_centre(view, x, y), 0.5f);
    if (times.x > times.y) return;
    const Candidate candidate = {
        t->number, (uint)(times.x * 65535.0f) | (uint)ceil(times.y * 65535.0f) << 16};
    cellist_insert(candidates, (uint)(y * view.width + x), candidate);
}
