// SPDX-License-Identifier: MIT
// Depth of field from the fragments of each pixel of one pinhole picture, by rays through the lens
// (Lee, Eisemann, Seidel, SIGGRAPH 2010, with planes instead of slabs of depth).
//
// In the space of the picture's x and y and of w = 1 / depth, lines stay lines and planes planes.
// A fragment is a piece of a plane over its pixel. A ray through the lens is a line: at w, it is
// `speed` * (w - focus) pixels away from the pixel that gets its light. It visits the pixels on its
// way front to back, and blends the planes that it crosses in each.
//
//   spans   for each pixel: where its planes begin, their number, and the bits of `reach`: the
//           largest difference of w between the centre of a plane and the rest of it
//   planes  nearest first: w at the pixel's centre, its growth per pixel along x and y, and the
//           bits of the node's index
//   ranges  the range of w in each tile: see lens_common.clh
//
// The method defines where nodes are:
//   OIT_NODES, OIT_NODES_PASS  the parameters, and the arguments that pass them on
//   OIT_FOR_EACH_NODE(n)       a loop over the indices of `pixel`, nearest first
//   OIT_NODE_AT(n)             the node

#ifndef OIT_NODES
#define OIT_NODES CELLIST_LISTS(OIT_NODE, fragments)
#define OIT_NODES_PASS CELLIST_PASS(fragments)
#define OIT_FOR_EACH_NODE(n)                                                                       \
    cellist_for_each(fragments, cellist_cell3(fragments, pixel.x, pixel.y, pixel.eye), n)
#define OIT_NODE_AT(n) cellist_get(fragments, n)
#endif

// Rays for each pixel in the area of the circle of confusion, and the fewest rays for a blurred
// pixel.
#define OIT_RAYS_PER_AREA 2.0f
#define OIT_LEAST_RAYS 8.0f
// A ray ends when its transmittance is at most this.
#define OIT_LEAST_LIGHT 0x1p-10f

// Writes the planes of each pixel. A pixel whose planes do not fit gets none. `used` counts all
// planes.
kernel void oit_find_planes(OIT_NODES, global uint4* spans, global float4* planes,
                            const uint capacity, volatile global uint* used,
                            volatile global uint* ranges, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    uint count = 0;
    OIT_FOR_EACH_NODE(counted) {
#ifdef OIT_LAYERS
        if (count == OIT_LAYERS) break;
#endif
        ++count;
    }
    const uint begin = count > 0 ? atomic_add(used, count) : 0;
    if (count == 0 || count > capacity || begin > capacity - count) {
        spans[pixel.pixel] = 0;
        return;
    }
    float reach = 0.0f, least = INFINITY, greatest = 0.0f;
    uint at = begin;
    OIT_FOR_EACH_NODE(n) {
        if (at == begin + count) break;
        const OitFragment fragment = oit_unpack(&pixel.frame, OIT_NODE_AT(n));
        const float w = 1.0f / fragment.depth;
        const float slope_x = w * fragment.slope_x, slope_y = w * fragment.slope_y;
        // The bound keeps w positive, and at most 1.5 times that of the centre.
        const float own = fmin(0.5f * (fabs(slope_x) + fabs(slope_y)), 0.5f * w);
        reach = fmax(reach, own);
        least = fmin(least, w - own);
        greatest = fmax(greatest, w + own);
        planes[at++] = (float4)(w, slope_x, slope_y, as_float(n));
    }
    spans[pixel.pixel] = (uint4)(begin, count, as_uint(reach), 0);
    oit_widen_range(ranges, &pixel, least, greatest);
}

#define OIT_CROSSINGS 4

// The planes that a ray crosses in a pixel, nearest first. They come in the order of their centres,
// so the nearest is blended only when the buffer is full or the pixel ends.
typedef struct {
    int count;
    float w[OIT_CROSSINGS];
    uint node[OIT_CROSSINGS];
} OitCrossings;

static inline void oit_blend_nearest(OIT_NODES, const OitPixel* pixel, OitCrossings* found,
                                     OitBlend* light) {
    OitFragment fragment = oit_unpack(&pixel->frame, OIT_NODE_AT(found->node[0]));
    fragment.depth = 1.0f / found->w[0];
    oit_blend(light, &fragment, pixel->ray_length);
    --found->count;
    for (int i = 0; i < found->count; ++i) {
        found->w[i] = found->w[i + 1];
        found->node[i] = found->node[i + 1];
    }
}

static inline void oit_add_crossing(OitCrossings* found, float w, uint node) {
    int at = found->count++;
    for (; at > 0 && found->w[at - 1] < w; --at) {
        found->w[at] = found->w[at - 1];
        found->node[at] = found->node[at - 1];
    }
    found->w[at] = w;
    found->node[at] = node;
}

// Blends the planes that a ray crosses in a pixel. The ray enters at `in` and leaves at `out`. Both
// are x and y from the pixel's centre, and w.
static inline void oit_blend_crossed(OIT_NODES, uint4 span, global const float4* planes,
                                     const OitPixel* pixel, float3 in, float3 out,
                                     OitBlend* light) {
    const float most_w = in.z + as_float(span.z), least_w = out.z - as_float(span.z);
    OitCrossings found;
    found.count = 0;
    for (uint n = span.x; n < span.x + span.y; ++n) {
        const float4 plane = planes[n];
        if (plane.x > most_w) continue;
        if (plane.x < least_w) break;
        // The distances in w from the plane to the ray, at both ends.
        const float before = in.z - plane.x - plane.y * in.x - plane.z * in.y;
        const float after = out.z - plane.x - plane.y * out.x - plane.z * out.y;
        if ((before > 0.0f) == (after > 0.0f)) continue;
        const float w = in.z + (out.z - in.z) * (before / (before - after));
        if (found.count == OIT_CROSSINGS) oit_blend_nearest(OIT_NODES_PASS, pixel, &found, light);
        oit_add_crossing(&found, w, as_uint(plane.w));
    }
    while (found.count > 0) oit_blend_nearest(OIT_NODES_PASS, pixel, &found, light);
}

// The light along a ray from `w_in` to the lesser `w_end`.
static inline OitBlend oit_trace(OIT_NODES, global const uint4* spans, global const float4* planes,
                                 const OitPixel* pixel, int width, int height, float2 speed,
                                 float focus, float w_in, float w_end) {
    OitBlend light = oit_empty_blend();
    // Coordinates are relative to the pixel, and mirrored so that x and y fall along the ray.
    const int sign_x = speed.x < 0.0f ? -1 : 1, sign_y = speed.y < 0.0f ? -1 : 1;
    const float speed_x = fabs(speed.x), speed_y = fabs(speed.y);
    const float slow_x = 1.0f / fmax(speed_x, 1e-20f), slow_y = 1.0f / fmax(speed_y, 1e-20f);
    const int right = width - 1 - pixel->x, below = height - 1 - pixel->y;
    const int most_x = sign_x > 0 ? right : pixel->x, most_y = sign_y > 0 ? below : pixel->y;
    const int least_x = most_x - (width - 1), least_y = most_y - (height - 1);
    w_in =
        fmin(w_in, focus + fmin(((float)most_x + 0.5f) * slow_x, ((float)most_y + 0.5f) * slow_y));
    w_end = fmax(w_end,
                 focus + fmax(((float)least_x - 0.5f) * slow_x, ((float)least_y - 0.5f) * slow_y));
    if (!(w_in > w_end)) return light;
    int x = clamp(convert_int_sat_rte(speed_x * (w_in - focus)), least_x, most_x);
    int y = clamp(convert_int_sat_rte(speed_y * (w_in - focus)), least_y, most_y);
    for (int steps = width + height; steps > 0; --steps) {
        const float next_x = focus + ((float)x - 0.5f) * slow_x;
        const float next_y = focus + ((float)y - 0.5f) * slow_y;
        const float w_out = fmax(fmax(next_x, next_y), w_end);
        const int2 at = (int2)(sign_x * x, sign_y * y);
        const uint4 span = spans[pixel->pixel + (ptrdiff_t)at.y * width + at.x];
        if (span.y > 0 && w_out < w_in) {
            const float3 in = (float3)(speed * (w_in - focus) - convert_float2(at), w_in);
            const float3 out = (float3)(speed * (w_out - focus) - convert_float2(at), w_out);
            oit_blend_crossed(OIT_NODES_PASS, span, planes, pixel, in, out, &light);
            if (oit_most(light.transmittance) <= fmax(OIT_LEAST_LIGHT, pixel->frame.epsilon)) break;
        }
        if (w_out <= w_end) break;
        w_in = w_out;
        if (next_x >= next_y)
            --x;
        else
            --y;
        if (x < least_x || y < least_y) break;
    }
    return light;
}

// Writes the mean of the rays of each pixel outside the margin. `scale` is the number of pixels by
// which a ray from the edge of the lens moves per unit of w.
kernel void oit_gather(OIT_NODES, global const uint4* spans, global const float4* planes,
                       global const uint2* ranges, const float scale, const float focus,
                       const uint most_rays, const int margin, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const int width = views[pixel.eye].width, height = views[pixel.eye].height;
    if (oit_is_in_margin(&pixel, width, height, margin)) return;
    const uint2 range = ranges[oit_tile_of(&pixel)];
    float3 sum = pixel.background;
    uint rays = 1;
    if (range.x <= range.y) {
        const float circle = oit_circle(range, scale, focus);
        // Within half a pixel, all rays see the same surfaces.
        if (circle > 0.5f)
            rays = (uint)clamp(OIT_RAYS_PER_AREA * M_PI_F * circle * circle, OIT_LEAST_RAYS,
                               (float)most_rays);
        rays = min(rays, most_rays);
        float2 direction = oit_first_direction(pixel.x, pixel.y);
        sum = 0.0f;
        for (uint i = 0; i < rays; ++i) {
            const float place = rays == 1 ? 0.0f : oit_place(i, rays);
            const OitBlend light =
                oit_trace(OIT_NODES_PASS, spans, planes, &pixel, width, height,
                          scale * place * direction, focus, as_float(range.y), as_float(range.x));
            sum += light.colour + light.transmittance * pixel.background;
            direction = oit_next_direction(direction);
        }
    }
    image[pixel.pixel] = (float4)(sum / (float)rays, 1.0f);
}
