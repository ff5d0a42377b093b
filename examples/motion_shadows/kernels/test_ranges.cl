// SPDX-License-Identifier: MIT
// Shadow test: a depth-time range is nearer at the sample's time (Hong and Oh, 2018, section 3.3).
#define TEST_TARGET CELLIST_LISTS(DepthTimeRange, ranges)
#define TEST_TARGET_PASS CELLIST_PASS(ranges)

static inline int is_blocked(TEST_TARGET, TEST_LIGHT, const Receiver r, float time, uint sample) {
    cellist_for_each(ranges, r.texel, node) {
        const DepthTimeRange range = cellist_get(ranges, node);
        if (!(range.begin <= time && time <= range.end) || range.triangle == r.triangle) continue;
        // NaN in a range without length, which blocks nothing.
        const float part = (time - range.begin) / (range.end - range.begin);
        const float depth = fma(part, range.depth_end - range.depth_begin, range.depth_begin);
        if (depth >= light.near_depth && depth < r.limit) return 1;
    }
    return 0;
}
