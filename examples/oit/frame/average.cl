// SPDX-License-Identifier: MIT
// The mean of the samples of each pixel.
kernel void oit_average(global const float4* samples, global float4* image, uint pixels) {
    const size_t pixel = get_global_id(0);
    if (pixel >= pixels) return;
    float3 sum = 0.0f;
    for (int s = 0; s < OIT_SAMPLES; ++s) sum += samples[pixel * OIT_SAMPLES + s].xyz;
    image[pixel] = (float4)(sum / (float)OIT_SAMPLES, 1.0f);
}
