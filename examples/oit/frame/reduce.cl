// SPDX-License-Identifier: MIT
// Between the full image and the reduced one, each of whose pixels stands for OIT_BLOCK x OIT_BLOCK
// of the full one's.

// Opaque depths that differ by this part of the farther one agree by half.
#define OIT_TOLERANCE 0.02f
// Of a pixel that bilinear interpolation leaves out.
#define OIT_LEAST_WEIGHT 1e-3f

// reduced: the greatest of the opaque depths of each block, as bits of floats, which are ordered as
// they are.
kernel void oit_shrink(global const uint* depths, global uint* reduced, int width, int height) {
    const int x = get_global_id(0), y = get_global_id(1);
    const size_t eye = get_global_id(2);
    uint farthest = 0;
    for (int v = OIT_BLOCK * y; v < min(OIT_BLOCK * (y + 1), height); ++v)
        for (int u = OIT_BLOCK * x; u < min(OIT_BLOCK * (x + 1), width); ++u)
            farthest = max(farthest, depths[(eye * height + v) * width + u]);
    reduced[(eye * get_global_size(1) + y) * get_global_size(0) + x] = farthest;
}

// How well two opaque depths agree, from 1 where they are equal to 0; infinity is one of them.
// Never 0, so that the nearest counts where none agrees.
static inline float oit_agreement(float a, float b) {
    const float near = 1.0f / fmin(a, b), far = 1.0f / fmax(a, b);
    const float apart = (near - far) / fmax(near, 1e-30f);
    const float tolerances = apart * apart / (OIT_TOLERANCE * OIT_TOLERANCE);
    return 1.0f / (1.0f + tolerances * tolerances);
}

// Puts what the transparent surfaces add, light[2 i], and let pass, light[2 i + 1], over the image.
kernel void oit_enlarge(global const float4* light,
#ifdef OIT_HAS_OPAQUE
                        global const uint* reduced_depths, global const uint* depths,
#endif
                        global float4* image, int reduced_width, int reduced_height) {
    const int x = get_global_id(0), y = get_global_id(1);
    const size_t eye = get_global_id(2);
    const size_t pixel = (eye * get_global_size(1) + y) * get_global_size(0) + x;
    // The pixel's centre in reduced pixels, from the centre of the first.
    const float centre_x = ((float)x + 0.5f) / OIT_BLOCK - 0.5f;
    const float centre_y = ((float)y + 0.5f) / OIT_BLOCK - 0.5f;

    float3 added = 0.0f, passing = 0.0f;
    float weights = 0.0f;
    for (int v = max(y / OIT_BLOCK - 1, 0); v <= min(y / OIT_BLOCK + 1, reduced_height - 1); ++v)
        for (int u = max(x / OIT_BLOCK - 1, 0); u <= min(x / OIT_BLOCK + 1, reduced_width - 1);
             ++u) {
            const size_t at = (eye * reduced_height + v) * reduced_width + u;
            // Bilinear; those around count where these do not agree.
            float weight = fmax(1.0f - fabs((float)u - centre_x), 0.0f) *
                               fmax(1.0f - fabs((float)v - centre_y), 0.0f) +
                           OIT_LEAST_WEIGHT;
#ifdef OIT_HAS_OPAQUE
            weight *= oit_agreement(as_float(reduced_depths[at]), as_float(depths[pixel]));
#endif
            added += weight * light[2 * at].xyz;
            passing += weight * light[2 * at + 1].xyz;
            weights += weight;
        }
    image[pixel] = (float4)((added + passing * image[pixel].xyz) / weights, 1.0f);
}
