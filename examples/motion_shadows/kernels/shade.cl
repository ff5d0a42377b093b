// SPDX-License-Identifier: MIT
// Makes the picture from samples. sums[pixel] is linear RGB and the number of samples in shadow.

// One work-item a pixel: adds the samples of a batch.
kernel void add_samples(const Shading shading, const Sampling sampling,
                        global const Receiver* receivers, global const float4* albedos, uint pixels,
                        global float4* sums) {
    const uint pixel = get_global_id(0);
    if (pixel >= pixels) return;
    float4 sum = sampling.first == 0 ? (float4)(0.0f) : sums[pixel];
    for (uint i = 0; i < sampling.count; ++i) {
        const Receiver r = receivers[(size_t)i * pixels + pixel];
        if (r.triangle == CELLIST_NONE) {
            sum.xyz += shading.background.xyz;
            continue;
        }
        const int is_blocked = (r.triangle & RECEIVER_BLOCKED) != 0;
        sum.xyz +=
            shaded(shading, albedos[r.triangle & ~RECEIVER_BLOCKED], is_blocked ? 0.0f : r.light);
        sum.w += (float)is_blocked;
    }
    sums[pixel] = sum;
}

// One work-item a pixel: adds one moment, from the nearest triangles to the camera and the light.
kernel void add_moment(RECEIVER_SCENE, global const ulong* seen_keys, global const ulong* lit_keys,
                       float time, float offset_x, float offset_y, global const float4* albedos,
                       global float4* sums) {
    const uint pixel = get_global_id(0);
    if (pixel >= (uint)(camera.width * camera.height)) return;
    const ulong key = seen_keys[pixel];
    if (key == NO_KEY) {
        sums[pixel].xyz += shading.background.xyz;
        return;
    }
    const float2 place =
        pixel_centre(camera, (int)pixel % camera.width, (int)pixel / camera.width) +
        (float2)(offset_x, offset_y);
    const Receiver r = receiver_at(RECEIVER_SCENE_PASS, (uint)key, place, time);
    const int is_blocked =
        r.texel != CELLIST_NONE && as_float((uint)(lit_keys[r.texel] >> 32)) < r.limit;
    sums[pixel] += (float4)(shaded(shading, albedos[r.triangle], is_blocked ? 0.0f : r.light),
                            (float)is_blocked);
}

// One work-item a pixel: the mean of `samples` samples, or 0 if there are none.
kernel void finish_picture(global const float4* sums, uint pixels, uint samples,
                           global float4* picture) {
    const uint pixel = get_global_id(0);
    if (pixel >= pixels) return;
    picture[pixel] = samples > 0 ? sums[pixel] / (float)samples : (float4)(0.0f);
}
