// SPDX-License-Identifier: MIT
// Adds `part` times a picture to the sum.
kernel void oit_add_picture(global const float4* picture, global float4* sum, uint pixels,
                            float part) {
    const size_t pixel = get_global_id(0);
    if (pixel < pixels) sum[pixel] += part * picture[pixel];
}
