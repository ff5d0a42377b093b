// SPDX-License-Identifier: MIT
// What is behind all transparent surfaces.
kernel void oit_backdrop(OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    OitBlendState blended = oit_blend_state();
    oit_write(OIT_SCREEN_PASS, &pixel, &blended);
}
