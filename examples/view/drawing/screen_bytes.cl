// Linear pictures as 8-bit sRGB for a window.
//
// picture: eye by eye, row by row from the top. bytes: red, green, blue and 255 of each pixel, all
// eyes side by side. One work-item a pixel of an eye.
static inline uint srgb_byte(float linear) {
    const float value = clamp(linear, 0.0f, 1.0f);
    const float encoded =
        value <= 0.0031308f ? 12.92f * value : 1.055f * powr(value, 1.0f / 2.4f) - 0.055f;
    return (uint)(255.0f * encoded + 0.5f);
}

kernel void screen_bytes(global const float4* picture, uint width, uint height, uint eyes,
                         global uint* bytes) {
    const uint i = get_global_id(0);
    if (i >= width * height * eyes) return;
    const uint x = i % width, y = i / width % height, eye = i / width / height;
    const float4 colour = isnan(picture[i]) ? 0.0f : picture[i];
    bytes[(y * eyes + eye) * width + x] =
        srgb_byte(colour.x) | srgb_byte(colour.y) << 8 | srgb_byte(colour.z) << 16 | 255u << 24;
}
