// SPDX-License-Identifier: MIT
// Pass: fragments of the prism of a moving triangle at the centres of texels (Hong and Oh, 2018,
// section 4.1). The prism is the triangle at t = 0 and at t = 1, and a side for each edge. A
// side has four facets, which meet in its centre.
//
// Signs of edge functions are exact for the rounded corners, and each edge has one sign for all of
// its facets. So the light's line through a texel meets an even number of facets. Fragments at and
// behind the light's plane count too, or the number could be odd.
#define SWEEP_TARGET CELLIST_LISTS(PrismFragment, fragments), global const float* farthest
#define SWEEP_TARGET_PASS CELLIST_PASS(fragments), farthest
#define SWEEP_REACH 0.0f
#ifdef SWEEP_GROUP
#define SWEEP_SHARES
#endif

// Corners are 0 to 2 at t = 0, 3 to 5 at t = 1, and 6 to 8 in the centres of the sides. Side k lies
// opposite vertex k. Facets are 4 k to 4 k + 3 of side k, then 12 for the triangle at t = 0 and
// 13 for that at t = 1.
#define PRISM_FACETS 14

static inline float corner_time(int corner) { return corner < 3 ? 0.0f : corner < 6 ? 1.0f : 0.5f; }

// The corners of a side in order around it, for j from 0 to 3. Both triangles at an edge start at
// the same vertex, so that they have the same fragments of their common side.
static inline int side_corner(const MovingTriangle* t, int k, int j) {
    const uint is_second = (uint)(j == 1 || j == 2);
    return (k + 1 + (int)(is_second ^ (t->turned >> k & 1))) % 3 + (j < 2 ? 0 : 3);
}

// A vertex relative to a place in the image.
static inline float4 corner_from(float4 vertex, float2 place) {
    return (float4)(relative_to(vertex, place), vertex.zw);
}

// Whether the place is on the positive side of the edge. A place on the edge counts as if it were
// moved slightly along y, and much less along x.
static inline uint edge_side(float4 a, float4 b) {
    float side = cross2(a.xy, b.xy);
    if (side == 0.0f) side = difference_of_products(a.z, b.x, b.z, a.x);
    if (side == 0.0f) side = difference_of_products(a.z, b.y, b.z, a.y);
    return (uint)(side >= 0.0f);
}

// A point of the edge from a to b, given by its place between their images.
static inline float4 edge_point(float4 a, float4 b, float part) {
    const float of_a = (1.0f - part) * b.z, of_b = part * a.z;
    return (of_a * a + of_b * b) / (of_a + of_b);
}

// Where the facets of a side meet: in the centre of the bilinear surface. But if the image of the
// edge at t = 0 (from a0 to b0) crosses that at t = 1 (from a1 to b1), they meet in the crossing
// point, half way between both edges. Two of the facets then have no area in the image.
static inline float4 side_centre(float4 a0, float4 b0, float4 b1, float4 a1) {
    const float4 mean = 0.25f * (a0 + b0 + b1 + a1);
    if (!(fmin(fmin(a0.z, b0.z), fmin(b1.z, a1.z)) > 0.0f)) return mean;
    // Edges that share an end do not cross there, whatever rounding says.
    if (all(a0 == a1) || all(b0 == b1) || all(a0 == b1) || all(b0 == a1)) return mean;
    const float2 a = a0.xy / a0.z, b = b0.xy / b0.z, c = a1.xy / a1.z, d = b1.xy / b1.z;
    const float of_a = cross2(d - c, a - c), of_b = cross2(d - c, b - c);
    const float of_c = cross2(b - a, c - a), of_d = cross2(b - a, d - a);
    if (!(of_a * of_b < 0.0f && of_c * of_d < 0.0f)) return mean;
    const float s = of_a / (of_a - of_b), u = of_c / (of_c - of_d);
    return 0.5f * (edge_point(a0, b0, s) + edge_point(a1, b1, u));
}

static inline void sweep_refuse(SWEEP_TARGET) {
    const PrismFragment none = {0.0f, 0.0f, 0};
    cellist_insert(fragments, CELLIST_NONE, none);
}

static inline uint is_inside(uint sides) { return (uint)(sides == 0 || sides == 7); }

// The facets that cover a place, a bit each. Corners are relative to the place. Adds the corners 6
// to 8 of facets that may cover it.
static inline uint covering_facets(const MovingTriangle* t, float4* corner) {
    // The sides of the edges at t = 0 and t = 1, and of the vertices' paths.
    uint begin = 0, end = 0, path = 0;
    for (int k = 0; k < 3; ++k) {
        begin |= edge_side(corner[side_corner(t, k, 0)], corner[side_corner(t, k, 1)]) << k;
        end |= edge_side(corner[side_corner(t, k, 3)], corner[side_corner(t, k, 2)]) << k;
        path |= edge_side(corner[k], corner[k + 3]) << k;
    }
    uint covering = is_inside(begin ^ t->turned) << 12 | is_inside(end ^ t->turned) << 13;
    for (int k = 0; k < 3; ++k) {
        const int i_a = side_corner(t, k, 0), i_b = side_corner(t, k, 1);
        const float4 a0 = corner[i_a], b0 = corner[i_b], b1 = corner[i_b + 3], a1 = corner[i_a + 3];
        // An edge that stays has no side.
        if (all(a0 == a1) && all(b0 == b1)) continue;
        const float2 low = fmin(fmin(a0.xy, b0.xy), fmin(b1.xy, a1.xy));
        const float2 high = fmax(fmax(a0.xy, b0.xy), fmax(b1.xy, a1.xy));
        if (any(low > 0.0f) || any(high < 0.0f)) continue;
        const float4 centre = side_centre(a0, b0, b1, a1);
        corner[6 + k] = centre;
        // Facet j has border j, spoke j + 1 and the reverse of spoke j.
        const uint borders = (begin >> k & 1) | (path >> i_b & 1) << 1 | (~end >> k & 1) << 2 |
                             (~path >> i_a & 1) << 3;
        const uint spokes = edge_side(a0, centre) | edge_side(b0, centre) << 1 |
                            edge_side(b1, centre) << 2 | edge_side(a1, centre) << 3;
        const uint next = spokes >> 1 | (spokes & 1) << 3;
        covering |= ((borders & next & ~spokes) | (~borders & ~next & spokes & 15)) << 4 * k;
    }
    return covering;
}

static inline uint2 sweep_parts(SWEEP_TARGET, const View view, const MovingTriangle* t, int x,
                                int y) {
    return (uint2)(0, triangle_least_depth(t) < farthest[y * view.width + x]);
}

static inline void sweep_part(SWEEP_TARGET, const View view, const MovingTriangle* t, int x, int y,
                              uint part) {
    const float2 place = pixel_centre(view, x, y);
    float4 corner[9];
    for (int k = 0; k < 3; ++k) {
        corner[k] = corner_from(t->begin[k], place);
        corner[k + 3] = corner_from(t->end[k], place);
    }
    const uint covering = covering_facets(t, corner);
    for (int facet = 0; facet < PRISM_FACETS; ++facet) {
        if (!(covering >> facet & 1)) continue;
        const int side = facet / 4, j = facet % 4;
        const int i = side < 3 ? side_corner(t, side, j) : 3 * j;
        const int next = side < 3 ? side_corner(t, side, (j + 1) % 4) : 3 * j + 1;
        const int last = side < 3 ? side + 6 : 3 * j + 2;
        const float4 a = corner[i], b = corner[next], c = corner[last];
        const float3 weights = (float3)(cross2(b.xy, c.xy), cross2(c.xy, a.xy), cross2(a.xy, b.xy));
        // Time is interpolated as depth is.
        const PrismFragment fragment = {
            depth_of(weights, (float3)(a.w, b.w, c.w)),
            depth_of(weights, (float3)(corner_time(i), corner_time(next), corner_time(last))),
            t->number};
        cellist_insert(fragments, (uint)(y * view.width + x), fragment);
    }
}
