// Shadow tests of the samples, and the picture.

// One work-item a sample: marks the texels that shadow tests will read.
kernel void mark_wanted(RECEIVER_SCENE, const Sampling sampling, global const uint* hits,
                        global uchar* wanted) {
    uint pixel, sample;
    if (!sample_of_item(camera, sampling, &pixel, &sample)) return;
    const uint hit = hits[(size_t)get_global_id(1) * (uint)(camera.width * camera.height) + pixel];
    if (hit == CELLIST_NONE) return;
    const Receiver r =
        receiver_at(RECEIVER_SCENE_PASS, hit, sample_place(camera, pixel, sample),
                    sample_time(pixel, sample, sampling.samples, 0));
    if (r.texel >= 0 && r.lambert > 0.0f) wanted[r.texel] = 1;
}

// One work-item a pixel: adds the samples of the batch. sums[pixel] is linear RGB and the number of
// samples in shadow.
kernel void add_samples(RECEIVER_SCENE, const Sampling sampling, global const uint* hits,
                        global const float4* albedos, global float4* sums) {
    const uint pixel = get_global_id(0), pixels = (uint)(camera.width * camera.height);
    if (pixel >= pixels) return;
    float4 sum = sampling.first == 0 ? (float4)(0.0f) : sums[pixel];
    for (uint i = 0; i < sampling.count; ++i) {
        const uint hit = hits[(size_t)i * pixels + pixel];
        if (hit == CELLIST_NONE) {
            sum.xyz += shading.background.xyz;
            continue;
        }
        const uint sample = sampling.first + i, triangle = hit & ~HIT_BLOCKED;
        const Receiver r =
            receiver_at(RECEIVER_SCENE_PASS, triangle, sample_place(camera, pixel, sample),
                        sample_time(pixel, sample, sampling.samples, 0));
        const int is_blocked = (hit & HIT_BLOCKED) != 0;
        sum.xyz += shaded(shading, albedos[triangle], r.texel >= 0 && !is_blocked
                                                          ? r.lambert * r.arriving : 0.0f);
        sum.w += (float)is_blocked;
    }
    sums[pixel] = sum;
}

// One work-item a pixel: one moment of the accumulated picture. `sums` as in add_samples.
kernel void add_moment(RECEIVER_SCENE, global const ulong* seen_keys, global const ulong* lit_keys,
                       float time, float offset_x, float offset_y, global const float4* albedos,
                       global float4* sums) {
    const uint pixel = get_global_id(0);
    if (pixel >= (uint)(camera.width * camera.height)) return;
    float4 sum = sums[pixel];
    const ulong key = seen_keys[pixel];
    if (key == 0x7FFFFFFFFFFFFFFFul) {
        sum.xyz += shading.background.xyz;
    } else {
        const uint triangle = (uint)key;
        const float2 place =
            pixel_centre(camera, (int)pixel % camera.width, (int)pixel / camera.width) +
            (float2)(offset_x, offset_y);
        const Receiver r = receiver_at(RECEIVER_SCENE_PASS, triangle, place, time);
        const int is_blocked = r.texel >= 0 && r.lambert > 0.0f &&
                               as_float((uint)(lit_keys[r.texel] >> 32)) < r.limit;
        sum.xyz += shaded(shading, albedos[triangle],
                          r.texel >= 0 && !is_blocked ? r.lambert * r.arriving : 0.0f);
        sum.w += (float)is_blocked;
    }
    sums[pixel] = sum;
}
