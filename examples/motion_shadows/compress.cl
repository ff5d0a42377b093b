// Fewer ranges with the same shadows, but for a bounded error of depth: ranges that touch in time
// and depth are merged where the depth stays linear, and what another range hides for all of its
// time is left out.

// Merged ranges that are still growing in a texel.
#define OPEN_MAX 4
// A range is divided into at most so many parts of linear depth.
#define LINEAR_PARTS_MAX 16

// A range that grows: its depth is depth + slope * (t - begin), for any slope between the two.
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

// Whether `front` is nearer than `p` for all of the time of `p`.
static inline int open_hides(const OpenPiece* front, const OpenPiece* p) {
    return front->begin <= p->begin && front->end >= p->end &&
           open_depth(front, p->begin) < open_depth(p, p->begin) &&
           open_depth(front, p->end) < open_depth(p, p->end);
}

// Lets a piece continue to `time`, if its depth stays within the tolerance of those there.
static inline int open_extend(OpenPiece* p, float middle_time, float middle, float time,
                              float depth, float tolerance) {
    float least = p->least_slope, most = p->most_slope;
    const float to_middle = 1.0f / (middle_time - p->begin), to_end = 1.0f / (time - p->begin);
    least = fmax(least, fmax((middle - tolerance - p->depth) * to_middle,
                             (depth - tolerance - p->depth) * to_end));
    most = fmin(most, fmin((middle + tolerance - p->depth) * to_middle,
                           (depth + tolerance - p->depth) * to_end));
    if (!(least <= most)) return 0;
    p->end = time;
    p->last = depth;
    p->least_slope = least;
    p->most_slope = most;
    return 1;
}

// Takes piece `which` out: stores it, unless another one hides it.
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

// A stretch of time in which the depth of a triangle is nearly linear.
typedef struct {
    float begin, end;
    float at_begin, at_middle, at_end;  // the depth
} Stretch;

static inline void add_stretch(CELLIST_LISTS(DepthPiece, pieces), uint texel, OpenPiece* open,
                               const Stretch s, float tolerance) {
    const float middle = 0.5f * (s.begin + s.end);
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end == s.begin && fabs(open[k].last - s.at_begin) <= tolerance &&
            open_extend(&open[k], middle, s.at_middle, s.end, s.at_end, tolerance))
            return;
    OpenPiece fresh = {s.begin, s.begin, s.at_begin, s.at_begin, -INFINITY, INFINITY};
    if (!open_extend(&fresh, middle, s.at_middle, s.end, s.at_end, tolerance)) {
        fresh.end = s.end;
        fresh.last = s.at_end;
        fresh.least_slope = fresh.most_slope = (s.at_end - s.at_begin) / (s.end - s.begin);
    }
    // The one that ended first makes room; those that are closed have ended at -1.
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
        // What ended before cannot grow any more.
#pragma unroll
        for (int k = 0; k < OPEN_MAX; ++k)
            if (open[k].end >= 0.0f && open[k].end < range.begin)
                close_piece(CELLIST_PASS(pieces), texel, open, k);
        MovingTriangle t;
        triangle_load(&t, lit, indices, range.triangle);
        Stretch s = {range.begin, range.end, 0.0f, 0.0f, 0.0f};
        s.at_begin = triangle_depth(&t, place, s.begin);
        s.at_middle = triangle_depth(&t, place, 0.5f * (s.begin + s.end));
        s.at_end = triangle_depth(&t, place, s.end);
        if (!(fmin(s.at_begin, fmin(s.at_middle, s.at_end)) >= light.near_depth)) continue;
        const float error = tolerance * (light.is_parallel ? light.pixel : light.pixel * s.at_middle);
        // The deviation from a line falls with the square of the length.
        const float bend = fabs(s.at_middle - 0.5f * (s.at_begin + s.at_end));
        const int parts = (int)clamp(ceil(sqrt(2.0f * bend / error)), 1.0f, (float)LINEAR_PARTS_MAX);
        for (int part = 1; part <= parts; ++part) {
            if (parts > 1) {
                s.end = part == parts ? range.end
                                      : fma((float)part / (float)parts, range.end - range.begin,
                                            range.begin);
                s.at_middle = triangle_depth(&t, place, 0.5f * (s.begin + s.end));
                s.at_end = triangle_depth(&t, place, s.end);
            }
            if (s.end > s.begin) add_stretch(CELLIST_PASS(pieces), texel, open, s, error);
            s.begin = s.end;
            s.at_begin = s.at_end;
        }
    }
#pragma unroll
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end >= 0.0f) close_piece(CELLIST_PASS(pieces), texel, open, k);
}
