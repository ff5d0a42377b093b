// SPDX-License-Identifier: MIT
// What comes before drawing: vertices are projected, and triangles are clipped and binned.

// ---- projection ---------------------------------------------------------------------------------

// Projects the vertices of all instances, a work-group for each batch of them. positions: 3 floats
// a vertex.
kernel void raster_transform(global const View* views, global const RasterInstance* instances,
                             global const RasterBatch* batches, global const float* positions,
                             global RasterVertex* vertices) {
    const RasterBatch batch = batches[get_group_id(0)];
    const uint i = batch.first + get_local_id(0);
    if (i >= batch.end) return;
    const RasterInstance instance = instances[batch.instance];
    const View view = views[instance.eye];
    vertices[i + instance.vertex_offset] = raster_project(&view, &instance, vload3(i, positions));
}

// ---- binning ------------------------------------------------------------------------------------
//
// Puts large triangles and the pieces of clipped ones into a queue, and the blocks of pixels that
// they touch into another.
//
//   bin_counts       of two frames that take turns; those of the turn start at 0, and count entries
//                    that a queue has no room for, too
//   ..._capacity     of the queues

// Work-items that look for the blocks of a triangle together. On CPUs, where a block has one
// work-item, each is faster alone. On GPUs, the group shares out few triangles among large teams,
// as each may cover much of the image.
static inline uint raster_bin_team(uint triangles) {
    if (RASTER_LANES == 1) return 1;
    uint team = 8;
    while (2 * team * max(triangles, 1u) <= get_local_size(0)) team *= 2;
    return team;
}

// Nothing more is counted beyond this, so that the counters cannot wrap.
#define RASTER_COUNT_MAX 0x80000000u

#define RASTER_BIN_QUEUES                                                                          \
    volatile global RasterCounts *bin_counts, const uint turn, global RasterTriangle *triangles,   \
        const uint triangles_capacity, global RasterBlock *blocks, const uint blocks_capacity

// Takes `wanted` entries of a queue, and returns the first.
static inline uint raster_take(volatile global uint* count, uint wanted) {
    return *count < RASTER_COUNT_MAX ? atomic_add(count, wanted) : RASTER_COUNT_MAX;
}

// The blocks of a bounding box.
typedef struct {
    int x, y, across, down;
} RasterBox;

static inline RasterBox raster_box(const RasterTriangle* t) {
    RasterBox box;
    box.x = t->x_begin / RASTER_BLOCK_PIXELS;
    box.y = t->y_begin / RASTER_BLOCK_PIXELS;
    box.across = (t->x_end - 1) / RASTER_BLOCK_PIXELS - box.x + 1;
    box.down = (t->y_end - 1) / RASTER_BLOCK_PIXELS - box.y + 1;
    return box;
}

// The next block of a box for a work-item of a team, row by row: at first `lane` blocks behind the
// upper left one, then a team's further.
static inline void raster_step(const RasterBox* box, uint blocks, int* x, int* y) {
    for (*x += blocks; *x >= box->across; *x -= box->across) ++*y;
}

// The upper left pixel of a block: x + 65536 * y.
static inline uint raster_block_place(const RasterBox* box, int x, int y) {
    return (box->x + x) * RASTER_BLOCK_PIXELS + 65536u * ((box->y + y) * RASTER_BLOCK_PIXELS);
}

// False if all that could be covered in a block's pixels is outside of one edge.
static inline bool raster_touches(const RasterTriangle* t, const RasterBox* box, int x, int y) {
#ifdef RASTER_EXACT
    const int reach = RASTER_SUBPIXELS / 2;
#else
    const int reach = RASTER_PIXEL_REACH;
#endif
    const int left = raster_centre((box->x + x) * RASTER_BLOCK_PIXELS) - reach;
    const int top = raster_centre((box->y + y) * RASTER_BLOCK_PIXELS) - reach;
    const int side = (RASTER_BLOCK_PIXELS - 1) * RASTER_SUBPIXELS + 2 * reach;
    bool touches = true;
    for (int i = 0; i < 3; ++i) {
        const int edge_x = raster_dy(t, i) < 0 ? left + side : left;
        const int edge_y = raster_dx(t, i) > 0 ? top + side : top;
        touches = touches && raster_edge(t, i, edge_x, edge_y) >= raster_bias(t, i);
    }
    return touches;
}

// Makes a triangle ready to be scanned. False where it is not visible.
static inline bool raster_ready(const View* view, RasterTriangle* t) {
    raster_bound(view, t);
    if (!raster_visible(t) || !raster_orient(t)) return false;
    raster_invert(t);
    return true;
}

// A group a batch: a work-item a triangle, and then all work-items, of which there may be more,
// share the triangles' blocks.
kernel void raster_bin(RASTER_BIN_QUEUES, const int small_pixels, RASTER_SCENE) {
    local uint listed[RASTER_BATCH * RASTER_PIECES_MAX];  // of the queue
    local RasterTriangle near[RASTER_BATCH];              // the first of these
    local uint listed_count, unclipped, block_count, first;
    const uint item = get_local_id(0);
    if (item == 0) listed_count = unclipped = block_count = 0;
    if (get_global_id(0) == 0) bin_counts->triangles[1 - turn] = bin_counts->blocks[1 - turn] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);

    RasterTriangle t;
    uint own = CELLIST_NONE;
    int outside_all, outside_any;
    if (item < RASTER_BATCH &&
        raster_load(RASTER_SCENE_PASS, get_group_id(0) * RASTER_BATCH + item, &t, &outside_all,
                    &outside_any) &&
        !outside_all) {
        const View view = views[instances[t.instance].eye];
        if (!outside_any) {
            if (!raster_small(&t, small_pixels) && raster_ready(&view, &t))
                own = atomic_inc(&unclipped);
        } else {
            RasterPolygon polygon;
            raster_clip_triangle(RASTER_SCENE_PASS, &view, &t, &polygon);
            for (int piece = 0; piece + 2 < polygon.count; ++piece) {
                RasterTriangle clipped = t;
                raster_piece(&view, &polygon, piece, &clipped);
                if (!raster_ready(&view, &clipped)) continue;
                const uint at = raster_take(&bin_counts->triangles[turn], 1);
                if (at >= triangles_capacity) continue;
                triangles[at] = clipped;
                const uint place = atomic_inc(&listed_count);
                listed[place] = at;
                if (place < RASTER_BATCH) near[place] = clipped;
            }
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0 && unclipped != 0) first = raster_take(&bin_counts->triangles[turn], unclipped);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (own != CELLIST_NONE && first + own < triangles_capacity) {
        const uint place = atomic_inc(&listed_count);
        triangles[first + own] = t;
        listed[place] = first + own;
        if (place < RASTER_BATCH) near[place] = t;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);

    const uint count = listed_count;
    const uint team_size = raster_bin_team(count), teams = get_local_size(0) / team_size;
    const uint team = item / team_size, lane = item % team_size;
    uint touched = 0, looked_at = 0, found = 0;  // a bit for each of the first 32 that it looks at
    for (uint n = team; n < count; n += teams) {
        const RasterTriangle one = n < RASTER_BATCH ? near[n] : triangles[listed[n]];
        const RasterBox box = raster_box(&one);
        int x = 0, y = 0;
        for (raster_step(&box, lane, &x, &y); y < box.down;
             raster_step(&box, team_size, &x, &y), ++looked_at) {
            if (!raster_touches(&one, &box, x, y)) continue;
            ++touched;
            if (looked_at < 32) found |= 1u << looked_at;
        }
    }
    uint next = touched != 0 ? atomic_add(&block_count, touched) : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0 && block_count != 0) first = raster_take(&bin_counts->blocks[turn], block_count);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (touched == 0) return;
    next += first;
    looked_at = 0;
    for (uint n = team; n < count; n += teams) {
        const RasterTriangle one = n < RASTER_BATCH ? near[n] : triangles[listed[n]];
        const RasterBox box = raster_box(&one);
        int x = 0, y = 0;
        for (raster_step(&box, lane, &x, &y); y < box.down;
             raster_step(&box, team_size, &x, &y), ++looked_at) {
            if (looked_at < 32 ? !(found >> looked_at & 1) : !raster_touches(&one, &box, x, y))
                continue;
            const RasterBlock block = {listed[n], raster_block_place(&box, x, y)};
            if (next < blocks_capacity) blocks[next] = block;
            ++next;
        }
    }
}
