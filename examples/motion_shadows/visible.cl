// What the camera sees at each sample: hits[sample * pixels + pixel] is the number of the nearest
// triangle, or CELLIST_NONE.

// Samples that one loop over the candidates of a pixel takes.
#define VISIBLE_SAMPLES 4

// One work-item a pixel.
kernel void find_visible(CELLIST_LISTS(Candidate, candidates), const View view,
                         global const MovingVertex* vertices, global const uint* indices,
                         const Sampling sampling, global uint* hits) {
    const uint pixel = get_global_id(0), pixels = (uint)(view.width * view.height);
    if (pixel >= pixels) return;
    const float2 centre = pixel_centre(view, (int)pixel % view.width, (int)pixel / view.width);
    const uint end = sampling.first + sampling.count;
    for (uint first = sampling.first; first < end; first += VISIBLE_SAMPLES) {
        float nearest[VISIBLE_SAMPLES];
        uint hit[VISIBLE_SAMPLES];
        float time[VISIBLE_SAMPLES];
        float2 place[VISIBLE_SAMPLES];
#pragma unroll
        for (int i = 0; i < VISIBLE_SAMPLES; ++i) {
            nearest[i] = INFINITY;
            hit[i] = CELLIST_NONE;
            time[i] = sample_time(pixel, first + i, sampling.samples, 0);
            place[i] = centre + sample_offset(pixel, first + i);
        }
        const uint earliest = (uint)(time[0] * 65535.0f);
        const uint latest = (uint)ceil(fmin(time[VISIBLE_SAMPLES - 1], 1.0f) * 65535.0f);
        cellist_for_each(candidates, pixel, node) {
            const Candidate candidate = cellist_get(candidates, node);
            if ((candidate.times & 65535u) > latest || candidate.times >> 16 < earliest) continue;
            MovingTriangle t;
            triangle_load(&t, vertices, indices, candidate.triangle);
#pragma unroll
            for (int i = 0; i < VISIBLE_SAMPLES; ++i) {
                uint sides;
                float3 depths;
                const float3 weights = triangle_weights(&t, place[i], time[i], &sides, &depths);
                if (sides != 0 && sides != 7) continue;
                const float depth = dot(weights, depths) / sum3(weights);
                // Equal depths are decided by the number, so that the order of lists does not matter.
                const int is_nearer =
                    depth < nearest[i] || (depth == nearest[i] && candidate.triangle < hit[i]);
                if (depth >= view.near_depth && is_nearer) {
                    nearest[i] = depth;
                    hit[i] = candidate.triangle;
                }
            }
        }
#pragma unroll
        for (int i = 0; i < VISIBLE_SAMPLES; ++i)
            if (first + i < end) hits[(size_t)(first + i - sampling.first) * pixels + pixel] = hit[i];
    }
}
