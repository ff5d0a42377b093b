// SPDX-License-Identifier: MIT
// Shadow test: the texel's sample in the same part of the exposure is nearer.
#define TEST_TARGET global const uint* depths
#define TEST_TARGET_PASS depths

static inline int is_blocked(TEST_TARGET, TEST_LIGHT, const Receiver r, float time, uint sample) {
    return as_float(depths[(size_t)sample * (uint)(light.width * light.height) + r.texel]) <
           r.limit;
}
