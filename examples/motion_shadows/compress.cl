// Fewer ranges with the same shadows, but for a bounded error of depth: ranges that touch in time
// and depth are merged where the depth stays linear, and what another range hides for all of its
// time is left out.

// Merged ranges that are still growing in a texel.
#define OPEN_MAX 6
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
                               int which) {
    const OpenPiece p = open[which];
    open[which].end = -1.0f;
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end >= 0.0f && open_hides(&open[k], &p)) return;
    const DepthPiece piece = {p.begin, p.end, p.depth, open_depth(&p, p.end)};
    cellist_insert(pieces, texel, piece);
}

static inline int first_to_end(const OpenPiece* open) {
    int which = 0;
    for (int k = 1; k < OPEN_MAX; ++k)
        if (open[k].end >= 0.0f && (open[which].end < 0.0f || open[k].end < open[which].end))
            which = k;
    return which;
}

// Adds a stretch of time in which the depth is nearly linear.
static inline void add_stretch(CELLIST_LISTS(DepthPiece, pieces), uint texel, OpenPiece* open,
                               const MovingTriangle* t, const View light, float2 place, float begin,
                               float end, float tolerance_texels) {
    const float at_begin = triangle_depth(t, place, begin);
    const float middle_time = 0.5f * (begin + end), middle = triangle_depth(t, place, middle_time);
    const float at_end = triangle_depth(t, place, end);
    if (!(middle >= light.near_depth)) return;
    const float tolerance =
        tolerance_texels * (light.is_parallel ? light.pixel : light.pixel * middle);
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end == begin && fabs(open[k].last - at_begin) <= tolerance &&
            open_extend(&open[k], middle_time, middle, end, at_end, tolerance))
            return;
    int which = first_to_end(open);
    for (int k = 0; k < OPEN_MAX; ++k)
        if (open[k].end < 0.0f) which = k;
    if (open[which].end >= 0.0f) close_piece(CELLIST_PASS(pieces), texel, open, which);
    const OpenPiece fresh = {begin, begin, at_begin, at_begin, -INFINITY, INFINITY};
    open[which] = fresh;
    if (!open_extend(&open[which], middle_time, middle, end, at_end, tolerance)) {
        open[which].end = end;
        open[which].last = at_end;
        open[which].least_slope = open[which].most_slope = (at_end - at_begin) / (end - begin);
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
    for (int k = 0; k < OPEN_MAX; ++k) open[k].end = -1.0f;
    cellist_for_each(ranges, texel, node) {
        const VisibleRange range = cellist_get(ranges, node);
        // What ended before cannot grow any more.
        for (int k = 0; k < OPEN_MAX; ++k) {
            const int which = first_to_end(open);
            if (open[which].end < 0.0f || open[which].end >= range.begin) break;
            close_piece(CELLIST_PASS(pieces), texel, open, which);
        }
        MovingTriangle t;
        triangle_load(&t, lit, indices, range.triangle);
        // The deviation from a line falls with the square of the length.
        const float size = light.is_parallel ? light.pixel : light.pixel * t.begin[0].w;
        const float a = triangle_depth(&t, place, range.begin);
        const float b = triangle_depth(&t, place, range.end);
        const float m = triangle_depth(&t, place, 0.5f * (range.begin + range.end));
        const float parts_wanted = sqrt(fabs(m - 0.5f * (a + b)) / (0.5f * tolerance * size));
        const int parts = (int)clamp(ceil(parts_wanted), 1.0f, (float)LINEAR_PARTS_MAX);
        float from = range.begin;
        for (int part = 1; part <= parts; ++part) {
            const float to = part == parts ? range.end
                                           : fma((float)part / (float)parts,
                                                 range.end - range.begin, range.begin);
            if (to > from)
                add_stretch(CELLIST_PASS(pieces), texel, open, &t, light, place, from, to,
                            tolerance);
            from = to;
        }
    }
    for (int k = 0; k < OPEN_MAX; ++k) {
        const int which = first_to_end(open);
        if (open[which].end < 0.0f) break;
        close_piece(CELLIST_PASS(pieces), texel, open, which);
    }
}
