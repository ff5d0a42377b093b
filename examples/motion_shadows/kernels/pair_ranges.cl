// SPDX-License-Identifier: MIT
// Pairs fragments of the same prism into depth-time ranges (Hong and Oh, 2018, section 4.3).

// Counts a fragment without a partner: the lists reject it.
static inline void drop_fragment(CELLIST_LISTS(DepthTimeRange, ranges)) {
    const DepthTimeRange none = {0.0f, 0.0f, 0.0f, 0.0f, 0};
    cellist_insert(ranges, CELLIST_NONE, none);
}

// One work-item a texel. The fragments are sorted by triangle, then by depth: the first makes a
// range with the second, and the third with the fourth.
kernel void pair_fragments(CELLIST_LISTS(DepthTimeRange, ranges),
                           CELLIST_LISTS(PrismFragment, fragments), uint texels) {
    const uint texel = get_global_id(0);
    if (texel >= texels) return;
    PrismFragment open = {0.0f, 0.0f, CELLIST_NONE};
    cellist_for_each(fragments, texel, node) {
        const PrismFragment fragment = cellist_get(fragments, node);
        if (fragment.triangle == open.triangle) {
            const PrismFragment begin = open.time <= fragment.time ? open : fragment;
            const PrismFragment end = open.time <= fragment.time ? fragment : open;
            const DepthTimeRange range = {begin.time, end.time, begin.depth, end.depth,
                                          open.triangle};
            cellist_insert(ranges, texel, range);
            open.triangle = CELLIST_NONE;
        } else {
            if (open.triangle != CELLIST_NONE) drop_fragment(CELLIST_PASS(ranges));
            open = fragment;
        }
    }
    if (open.triangle != CELLIST_NONE) drop_fragment(CELLIST_PASS(ranges));
}
