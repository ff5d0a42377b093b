// SPDX-License-Identifier: MIT
// Shadow test: a merged range is nearer at the sample's time.
#define TEST_TARGET CELLIST_LISTS(DepthPiece, pieces)
#define TEST_TARGET_PASS CELLIST_PASS(pieces)

static inline int is_blocked(TEST_TARGET, TEST_LIGHT, const Receiver r, float time, uint sample) {
    cellist_for_each(pieces, r.texel, node) {
        const DepthPiece piece = cellist_get(pieces, node);
        if (!(piece.begin <= time && time < piece.end)) continue;
        const float part = (time - piece.begin) / (piece.end - piece.begin);
        if (fma(part, piece.depth_end - piece.depth_begin, piece.depth_begin) < r.limit) return 1;
    }
    return 0;
}
