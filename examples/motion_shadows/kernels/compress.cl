// SPDX-License-Identifier: MIT
// Merges ranges that touch in time and depth where one line in time is close to their depths.
// Leaves out a merged range that another open one hides for all of its time. So a texel has fewer
// ranges, and the error of their depths stays within the tolerance.
//
// A stretch of a range counts as linear if its depth deviates from its chord by at most LINEAR_PART
// of the tolerance. A merged range stays within the rest of the tolerance at the ends of each
// stretch. So the sum of both errors is within the tolerance at all times.

// Merged ranges of a texel that are open: they may still grow.
#define OPEN_MAX 4
#define LINEAR_PART 0.125f
// A stretch that is at most STRETCH_LEAST of a range counts as linear. Times at which the depth
// passes the near plane are off by less than NEAR_LEAST.
#define STRETCH_LEAST 0x1p-10f
#define NEAR_LEAST 0x1p-16f

// An open merged range. Its depth is depth + slope * (t - begin), for any slope from least_slope to
// most_slope.
typedef struct {
    float begin, end;
    float depth, last;  // at its begin and its end so far
    float least_slope, most_slope;
} OpenPiece;

static inline float open_slope(const OpenPiece* p) {
    // The slope to the last depth, if it is allowed, so that neighbours fit.
    const float slope = (p->last - p->depth) / (p->end - p->begin);
    return fmin(fmax(slope, p->least_slope), p->most_slope);
}

static inline float open_depth(const OpenPiece* p, float time) {
    return fma(open_slope(p), time - p->begin, p->depth);
}

// Whether `front` is nearer than `p` for all of the time of `p`, whatever slope `front` gets.
static inline int open_hides(const OpenPiece* front, const OpenPiece* p) {
    return front->begin <= p->begin && front->end >= p->end &&
           fma(front->most_slope, p->begin - front->begin, front->depth) <
               open_depth(p, p->begin) &&
           fma(front->most_slope, p->end - front->begin, front->depth) < open_depth(p, p->end);
}

// A stretch of time in which the depth of a triangle is nearly linear.
typedef struct {
    float begin, end;
    float at_begin, at_end;  // the depth
} Stretch;

// Lets a piece continue with a stretch, if its depth stays within `allowed` of both ends.
static inline int open_extend(OpenPiece* p, const Stretch s, float allowed) {
    float least = p->least_slope, most = p->most_slope;
    if (s.begin > p->begin) {
        const float to_begin = 1.0f / (s.begin - p->begin);
        least = fmax(least, (s.at_begin - allowed - p->depth) * to_begin);
        most = fmin(most, (s.at_begin + allowed - p->depth) * to_begin);
    }
    const float to_end = 1.0f / (s.end - p->begin);
    least = fmax(least, (s.at_end - allowed - p->depth) * to_end);
    most = fmin(most, (s.at_end + allowed - p->depth) * to_end);
    if (!(least <= most)) return 0;
    p->end = s.end;
    p->last = s.at_end;
    p->least_slope = least;
    p->most_slope = most;
    return 1;
}

// Closes piece `which`, and stores it unless another open piece hides it.
static inline void close_piece(CELLIST_LISTS(DepthPiece, pieces), uint texel, OpenPiece* open,
                               const int which) {
    const OpenPiece p = open[which];
    open[which].end = -1.0f;
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end >= 0.0f && open_hides(&open[k], &p)) return;
    const DepthPiece piece = {p.begin, p.end, p.depth, open_depth(&p, p.end)};
    cellist_insert(pieces, texel, piece);
}

static inline void add_stretch(CELLIST_LISTS(DepthPiece, pieces), uint texel, OpenPiece* open,
                               const Stretch s, float tolerance) {
    const float allowed = (1.0f - LINEAR_PART) * tolerance;
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end == s.begin && fabs(open[k].last - s.at_begin) <= tolerance &&
            open_extend(&open[k], s, allowed))
            return;
    OpenPiece fresh = {s.begin, s.begin, s.at_begin, s.at_begin, -INFINITY, INFINITY};
    open_extend(&fresh, s, allowed);
    // The piece that ended first makes room. Closed pieces end at -1.
    float first_end = open[0].end;
#pragma unroll
    for (int k = 1; k < OPEN_MAX; ++k) first_end = fmin(first_end, open[k].end);
    int is_placed = 0;
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k)
        if (!is_placed && open[k].end == first_end) {
            if (first_end >= 0.0f) close_piece(CELLIST_PASS(pieces), texel, open, k);
            open[k] = fresh;
            is_placed = 1;
        }
}

// One work-item a texel.
kernel void compress_ranges(CELLIST_LISTS(DepthPiece, pieces), CELLIST_LISTS(VisibleRange, ranges),
                            const View light, global const MovingVertex* lit,
                            global const uint* indices, uint first_texel, uint texels,
                            float tolerance) {
    if (get_global_id(0) >= texels) return;
    const uint texel = first_texel + get_global_id(0);
    const float2 place = pixel_centre(light, (int)texel % light.width, (int)texel / light.width);
    OpenPiece open[OPEN_MAX];
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k) open[k].end = -1.0f;
    cellist_for_each(ranges, texel, node) {
        const VisibleRange range = cellist_get(ranges, node);
        // Pieces that ended earlier cannot grow any more.
#pragma unroll
        for (int k = 0; k < OPEN_MAX; ++k)
            if (open[k].end >= 0.0f && open[k].end < range.begin)
                close_piece(CELLIST_PASS(pieces), texel, open, k);
        MovingTriangle t;
        triangle_load(&t, lit, indices, range.triangle);
        Stretch s = {range.begin, range.end, triangle_depth(&t, place, range.begin), 0.0f};
        const float least = fmax(STRETCH_LEAST * (range.end - range.begin), NEAR_LEAST);
        while (s.begin < range.end) {
            const float third = (s.end - s.begin) / 3.0f;
            const float at_first = triangle_depth(&t, place, s.begin + third);
            const float at_second = triangle_depth(&t, place, s.end - third);
            s.at_end = triangle_depth(&t, place, s.end);
            const float nearest = fmin(fmin(s.at_begin, at_first), fmin(at_second, s.at_end));
            const float farthest = fmax(fmax(s.at_begin, at_first), fmax(at_second, s.at_end));
            const float error = tolerance * light.pixel *
                                (light.is_parallel ? 1.0f : fmax(nearest, light.near_depth));
            // Between these times, a cubic deviates by at most 1.3 times as much. The depth is a
            // cubic over a quadratic, which is close to a cubic on a short stretch.
            const float slope = (s.at_end - s.at_begin) / 3.0f;
            const float bend = 1.34f * fmax(fabs(at_first - s.at_begin - slope),
                                            fabs(s.at_end - at_second - slope));
            const int is_seen = nearest >= light.near_depth;
            const int is_hidden = farthest + 2.0f * bend < light.near_depth;
            const float length = s.end - s.begin;
            if ((is_seen && bend > LINEAR_PART * error && length > least) ||
                (!is_seen && !is_hidden && length > NEAR_LEAST)) {
                s.end = s.begin + 0.5f * length;
                continue;
            }
            if (!is_hidden && at_first + at_second >= 2.0f * light.near_depth)
                add_stretch(CELLIST_PASS(pieces), texel, open, s, error);
            s.begin = s.end;
            s.at_begin = s.at_end;
            s.end = fmin(range.end, s.begin + 2.0f * length);
        }
    }
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end >= 0.0f) close_piece(CELLIST_PASS(pieces), texel, open, k);
}
