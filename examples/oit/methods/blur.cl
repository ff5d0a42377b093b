// SPDX-License-Identifier: MIT
// Depth of field from one picture with one depth a pixel: a gather over the circle of confusion
// (Potmesil, Chakravarty 1981), in which a neighbour counts if its own circle reaches the pixel.

#ifdef OIT_STORES
// Stores the depth of the nearest surface in each pixel.
#define OIT_TARGET volatile global uint* depth_bits_of_nearest
#define OIT_TARGET_PASS depth_bits_of_nearest

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    atomic_min(&depth_bits_of_nearest[location->pixel], as_uint(fragment->depth));
}

#else

// Neighbours that a pixel reads for each ray of --lens-rays.
#define OIT_TAPS_PER_RAY 4

// Copies the pinhole picture to `sharp`: its colours, and 1 / depth, which is 0 where there is no
// surface.
kernel void oit_take_sharp(global const uint* depth_bits_of_nearest, global float4* sharp,
                           volatile global uint* ranges, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const float w = 1.0f / as_float(depth_bits_of_nearest[pixel.pixel]);
    sharp[pixel.pixel] = (float4)(image[pixel.pixel].xyz, w);
    if (w > 0.0f) oit_widen_range(ranges, &pixel, w, w);
}

kernel void oit_blur(global const float4* sharp, global const uint2* ranges, const float scale,
                     const float focus, const uint rays, const int margin, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const int width = views[pixel.eye].width, height = views[pixel.eye].height;
    if (oit_is_in_margin(&pixel, width, height, margin)) return;
    const uint2 range = ranges[oit_tile_of(&pixel)];
    if (range.x > range.y) return;
    const float4 own = sharp[pixel.pixel];
    const float own_circle = own.w > 0.0f ? scale * fabs(own.w - focus) : 1e30f;
    const float circle = oit_circle(range, scale, focus);
    const uint taps = OIT_TAPS_PER_RAY * rays;
    const float area = circle * circle / (float)taps;  // of a tap; no area has the factor pi
    float weights = 1.0f / fmax(3.0f * own_circle * own_circle, 1.0f);
    if (!(own.w > 0.0f)) weights = 0.1f / (float)taps;
    float3 sum = weights * own.xyz;
    float2 direction = oit_first_direction(pixel.x, pixel.y);
    for (uint i = 0; i < taps; ++i, direction = oit_next_direction(direction)) {
        const float distance = circle * oit_place(i, taps);
        const int x = pixel.x + convert_int_sat_rte(distance * direction.x);
        const int y = pixel.y + convert_int_sat_rte(distance * direction.y);
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const float4 other = sharp[((size_t)pixel.eye * height + y) * width + x];
        float reach = other.w > 0.0f ? scale * fabs(other.w - focus) : circle;
        // A farther surface does not leak over a nearer one in focus.
        if (other.w < own.w) reach = fmin(reach, own_circle);
        if (distance > fmax(reach, 0.5f)) continue;
        const float weight = area / fmax(reach * reach, 0.25f);
        sum += weight * other.xyz;
        weights += weight;
    }
    image[pixel.pixel] = (float4)(sum / weights, 1.0f);
}
#endif
