// SPDX-License-Identifier: MIT
// Shadow test: a triangle covers the texel at the sample's time, and is nearer at that time.
#define TEST_TARGET CELLIST_LISTS(VisibleRange, ranges)
#define TEST_TARGET_PASS CELLIST_PASS(ranges)

static inline int is_blocked(TEST_TARGET, TEST_LIGHT, const Receiver r, float time, uint sample) {
    const float2 place =
        pixel_centre(light, (int)r.texel % light.width, (int)r.texel / light.width);
    cellist_for_each(ranges, r.texel, node) {
        const VisibleRange range = cellist_get(ranges, node);
        if (range.begin > time || range.end <= time || range.triangle == r.triangle) continue;
        MovingTriangle t;
        triangle_load(&t, lit, indices, range.triangle);
        const float depth = triangle_depth(&t, place, time);
        if (depth >= light.near_depth && depth < r.limit) return 1;
    }
    return 0;
}
