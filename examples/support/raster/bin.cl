// Puts the blocks of pixels that large triangles and the pieces of clipped ones touch into a queue.
//
//   count     blocks so far, from 0; those that the queue has no room for are counted as well
//   capacity  of the queue

// Blocks that a work-item looks at alone. Where a triangle's bounding box has more, all work-items of the
// group share them.
#define RASTER_OWN_BLOCKS 16

// More blocks than this are not counted on, so that the counter cannot wrap.
#define RASTER_BLOCKS_MAX 0x80000000u

#define RASTER_QUEUE                                                                               \
    volatile global uint *count, global RasterBlock *queue, const uint capacity
#define RASTER_QUEUE_PASS count, queue, capacity

// The blocks of a bounding box, row by row.
typedef struct {
    int x, y, across;
    uint all;
} RasterBox;

static inline RasterBox raster_box(const RasterTriangle* t) {
    RasterBox box;
    box.x = t->x_begin / RASTER_BLOCK_PIXELS;
    box.y = t->y_begin / RASTER_BLOCK_PIXELS;
    box.across = (t->x_end - 1) / RASTER_BLOCK_PIXELS - box.x + 1;
    box.all = box.across * ((t->y_end - 1) / RASTER_BLOCK_PIXELS - box.y + 1);
    return box;
}

static inline RasterBlock raster_block(const RasterBox* box, uint i, uint triangle, uint piece) {
    const RasterBlock block = {triangle, piece,
                               (box->x + (int)i % box->across) * RASTER_BLOCK_PIXELS,
                               (box->y + (int)i / box->across) * RASTER_BLOCK_PIXELS};
    return block;
}

// False where no sample of the block is covered, because all lie outside of one edge.
static inline bool raster_touches(const RasterTriangle* t, const RasterBlock* block) {
    const int reach = RASTER_SAMPLES == 1 ? 0 : RASTER_REACH;
    const int left = raster_centre(block->x) - reach;
    const int top = raster_centre(block->y) - reach;
    const int side = (RASTER_BLOCK_PIXELS - 1) * RASTER_SUBPIXELS + 2 * reach;
    bool touches = true;
    for (int i = 0; i < 3; ++i) {
        const int x = raster_dy(t, i) < 0 ? left + side : left;
        const int y = raster_dx(t, i) > 0 ? top + side : top;
        touches = touches && raster_edge(t, i, x, y) >= raster_bias(t, i);
    }
    return touches;
}

// Every RASTER_BATCH-th block of all pieces of a triangle, from block `lane` on.
static void raster_share(RASTER_QUEUE, RASTER_SCENE, uint triangle, uint lane) {
    RasterTriangle t;
    int outside_all, outside_any;
    raster_load(RASTER_SCENE_PASS, triangle, &t, &outside_all, &outside_any);
    const View view = views[instances[t.instance].eye];
    RasterPolygon polygon;
    polygon.count = 3;
    if (outside_any) raster_clip_triangle(RASTER_SCENE_PASS, &view, &t, &polygon);
    for (int piece = 0; piece + 2 < polygon.count; ++piece) {
        if (outside_any) raster_piece(&view, &polygon, piece, &t);
        raster_bound(&view, &t);
        if (!raster_visible(&t) || !raster_orient(&t)) continue;
        const RasterBox box = raster_box(&t);
        for (uint i = lane; i < box.all; i += RASTER_BATCH) {
            const RasterBlock block = raster_block(&box, i, triangle, piece);
            if (!raster_touches(&t, &block) || *count >= RASTER_BLOCKS_MAX) continue;
            const uint at = atomic_inc(count);
            if (at < capacity) queue[at] = block;
        }
    }
}

// A work-item a triangle.
kernel void raster_bin(RASTER_QUEUE, RASTER_SCENE) {
    local uint shared[RASTER_BATCH];  // triangles that the group shares
    local uint shared_count, wanted, first;
    const uint lane = get_local_id(0), triangle = get_global_id(0);
    if (lane == 0) shared_count = wanted = 0;
    barrier(CLK_LOCAL_MEM_FENCE);

    RasterTriangle t;
    int outside_all, outside_any;
    RasterBox box;
    bool owns = false;
    if (raster_load(RASTER_SCENE_PASS, triangle, &t, &outside_all, &outside_any) && !outside_all) {
        bool shares = outside_any;
        if (!outside_any) {
            const View view = views[instances[t.instance].eye];
            raster_bound(&view, &t);
            if (!raster_small(&t) && raster_visible(&t) && raster_orient(&t)) {
                box = raster_box(&t);
                owns = box.all <= RASTER_OWN_BLOCKS;
                shares = !owns;
            }
        }
        if (shares) shared[atomic_inc(&shared_count)] = triangle;
    }
    uint at = 0, end = 0;
    if (owns) {
        for (uint i = 0; i < box.all; ++i) {
            const RasterBlock block = raster_block(&box, i, triangle, 0);
            if (raster_touches(&t, &block)) ++end;
        }
        at = atomic_add(&wanted, end);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0)
        first = wanted != 0 && *count < RASTER_BLOCKS_MAX ? atomic_add(count, wanted) : capacity;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (owns && first < capacity) {
        at += first;
        for (uint i = 0; i < box.all; ++i) {
            const RasterBlock block = raster_block(&box, i, triangle, 0);
            if (!raster_touches(&t, &block)) continue;
            if (at < capacity) queue[at] = block;
            ++at;
        }
    }
    for (uint i = 0; i < shared_count; ++i)
        raster_share(RASTER_QUEUE_PASS, RASTER_SCENE_PASS, shared[i], lane);
}
