// SPDX-License-Identifier: MIT
// Linear pictures as 8-bit sRGB for a window.
//
// picture: eye by eye, row by row from the top. encoded: the bytes of linear values, evenly spaced
// in their square roots: powr() would take most of a frame's time on processors. bytes: red, green,
// blue and 255 of each pixel, all eyes side by side. One work-item a pixel of an eye.
static inline uint screen_byte(float linear, global const uchar* encoded) {
    return encoded[(uint)((SCREEN_STEPS - 1) * sqrt(clamp(linear, 0.0f, 1.0f)) + 0.5f)];
}

kernel void screen_bytes(global const float4* picture, global const uchar* encoded, uint width,
                         uint height, uint eyes, global uint* bytes) {
    const uint i = get_global_id(0);
    if (i >= width * height * eyes) return;
    const uint x = i % width, y = i / width % height, eye = i / width / height;
    const float4 pixel = picture[i];
    const float4 colour = select(pixel, (float4)(0.0f), isnan(pixel));
    bytes[(y * eyes + eye) * width + x] = screen_byte(colour.x, encoded) |
                                          screen_byte(colour.y, encoded) << 8 |
                                          screen_byte(colour.z, encoded) << 16 | 255u << 24;
}
