// SPDX-License-Identifier: MIT
// Turns what the camera sees at each sample into receivers: receivers[sample * pixels + pixel].

// One work-item a sample. farthest[texel] becomes the greatest limit of the texel's receivers: what
// is farther from the light blocks none of them.
kernel void make_receivers(RECEIVER_SCENE, const Sampling sampling, global const ulong* keys,
                           global Receiver* receivers, global float* farthest) {
    const uint pixel = get_global_id(0), pixels = (uint)(camera.width * camera.height);
    if (pixel >= pixels) return;
    const uint sample = sampling.first + get_global_id(1);
    const size_t place = (size_t)get_global_id(1) * pixels + pixel;
    const ulong key = keys[place];
    Receiver r = {CELLIST_NONE, CELLIST_NONE, 0.0f, 0.0f};
    if (key != NO_KEY)
        r = receiver_at(RECEIVER_SCENE_PASS, (uint)key,
                        pixel_centre(camera, (int)pixel % camera.width, (int)pixel / camera.width) +
                            sample_offset(pixel, sample),
                        sample_time(pixel, sample, sampling.samples, 0));
    receivers[place] = r;
    if (r.texel == CELLIST_NONE || !(r.limit > 0.0f)) return;
    // Positive floats are ordered as their bits are. Limits only grow, so a stale limit does no
    // harm.
    volatile global uint* bits = (volatile global uint*)farthest + r.texel;
    if (as_uint(r.limit) > *bits) atomic_max(bits, as_uint(r.limit));
}
