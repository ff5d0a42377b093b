// SPDX-License-Identifier: MIT
// Shadow test: the triangle in a shadow map of one moment is nearer.
#define TEST_TARGET global const ulong* keys
#define TEST_TARGET_PASS keys

static inline int is_blocked(TEST_TARGET, TEST_LIGHT, const Receiver r, float time, uint sample) {
    return as_float((uint)(keys[r.texel] >> 32)) < r.limit;
}
