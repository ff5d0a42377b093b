// SPDX-License-Identifier: MIT
// Copies an image without the margin on each side.
kernel void oit_cut_out(global const float4* wide, global float4* image, int margin) {
    const size_t x = get_global_id(0), y = get_global_id(1), eye = get_global_id(2);
    const size_t width = get_global_size(0), height = get_global_size(1);
    image[(eye * height + y) * width + x] =
        wide[(eye * (height + 2 * margin) + y + margin) * (width + 2 * margin) + x + margin];
}
