// Puts every triangle into the list of each cell that it comes closer to than GRID_MARGIN. A
// triangle that is not finite is rejected. One that reaches out of the grid is in the list of
// those, too.
//
// Overlap of a triangle and a cell, with margins for rounding, so that no cell is missed: Schwarz,
// Seidel: "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia 2010. Yang et al.
// 2010, section 4.2, take all cells of the bounding box: up to 1.5 times as many (triangle_grid,
// dragon.ply in 256 cells).

// A line p * n.x + q * n.y + offset = 0 in a coordinate plane; negative where the cell whose lower
// corner is at p, q lies outside of it.
typedef struct {
    float2 n;
    float offset;
} GridEdge;

// What is the same for all cells of a triangle. Cells count from `low`.
typedef struct {
    int3 low, last;
    float3 n;            // normal
    float under, above;  // of the plane, for a cell at 0
    GridEdge xy[3], yz[3], zx[3];
    int is_row;  // at most one cell wide in two axes: every cell overlaps
} GridOverlap;

static GridEdge grid_edge(float2 a, float2 b, float facing, float margin) {
    GridEdge edge;
    edge.n = (float2)(a.y - b.y, b.x - a.x) * (facing < 0.0f ? -1.0f : 1.0f);
    edge.offset = fmax(edge.n.x, 0.0f) + fmax(edge.n.y, 0.0f) - dot(edge.n, a) +
                  (fabs(edge.n.x) + fabs(edge.n.y)) * margin;
    return edge;
}

static int grid_is_beyond(GridEdge edge, float p, float q) {
    return edge.n.x * p + edge.n.y * q + edge.offset < 0.0f;
}

// False where the triangle does not come near the grid. `reaches_out` tells whether it reaches out
// of the grid.
static int grid_overlap_begin(GridOverlap* t, const GridCells cells, float3 a, float3 b, float3 c,
                              int* reaches_out) {
    a = grid_in_cells(cells, a);
    b = grid_in_cells(cells, b);
    c = grid_in_cells(cells, c);
    const float3 extent = convert_float3(grid_extent(cells));
    const float3 low = fmin(a, fmin(b, c)), high = fmax(a, fmax(b, c));
    *reaches_out = !all(low >= -GRID_CLIP_ERROR && high <= extent + GRID_CLIP_ERROR);
    if (!all(high >= -GRID_MARGIN && low <= extent + GRID_MARGIN)) return 0;
    t->low = convert_int3(fmax(low - GRID_MARGIN, 0.0f));
    t->low = min(t->low, convert_int3(extent) - 1);
    t->last = convert_int3(fmin(high + GRID_MARGIN, extent - 1.0f)) - t->low;
    t->is_row = (t->last.x == 0) + (t->last.y == 0) + (t->last.z == 0) >= 2;
    if (t->is_row) return 1;

    const float3 corner = convert_float3(t->low);
    a -= corner;
    b -= corner;
    c -= corner;
    const float3 ab = b - a, ac = c - a;
    t->n = cross(ab, ac);
    // Coordinates up to `reach` are rounded, and so are products of them.
    const float3 far = fmax(fabs(low - corner), fabs(high - corner));
    const float reach = fmax(far.x, fmax(far.y, far.z)) + 1.0f;
    const float margin = 1.5f * GRID_MARGIN + reach * 0x1p-20f;
    const float3 ab_size = fabs(ab), ac_size = fabs(ac);
    const float slack = (fabs(t->n.x) + fabs(t->n.y) + fabs(t->n.z)) * margin +
                        (ab_size.x + ab_size.y + ab_size.z) * (ac_size.x + ac_size.y + ac_size.z) *
                            reach * 0x1p-20f;
    const float distance = -dot(t->n, a);
    t->under = distance + fmin(t->n.x, 0.0f) + fmin(t->n.y, 0.0f) + fmin(t->n.z, 0.0f) - slack;
    t->above = distance + fmax(t->n.x, 0.0f) + fmax(t->n.y, 0.0f) + fmax(t->n.z, 0.0f) + slack;
    const float3 corners[4] = {a, b, c, a};
    for (int i = 0; i < 3; ++i) {
        const float3 p = corners[i], q = corners[i + 1];
        t->xy[i] = grid_edge(p.xy, q.xy, t->n.z, margin);
        t->yz[i] = grid_edge(p.yz, q.yz, t->n.x, margin);
        t->zx[i] = grid_edge(p.zx, q.zx, t->n.y, margin);
    }
    return 1;
}

// Whether a column of cells along x overlaps, seen along x.
static int grid_column_overlaps(const GridOverlap* t, float y, float z) {
    return !(grid_is_beyond(t->yz[0], y, z) || grid_is_beyond(t->yz[1], y, z) ||
             grid_is_beyond(t->yz[2], y, z));
}

// Whether a cell of such a column overlaps.
static int grid_cell_overlaps(const GridOverlap* t, float x, float y, float z) {
    const float distance = t->n.x * x + t->n.y * y + t->n.z * z;
    return !(distance + t->under > 0.0f || distance + t->above < 0.0f ||
             grid_is_beyond(t->xy[0], x, y) || grid_is_beyond(t->xy[1], x, y) ||
             grid_is_beyond(t->xy[2], x, y) || grid_is_beyond(t->zx[0], z, x) ||
             grid_is_beyond(t->zx[1], z, x) || grid_is_beyond(t->zx[2], z, x));
}

static uint grid_columns(const GridOverlap* t) {
    return (uint)(t->last.y + 1) * (uint)(t->last.z + 1);
}

// Inserts a triangle into its cells in columns begin, begin + step, ... before `end`.
static void grid_insert_columns(CELLIST_LISTS(GridEntry, entries), const GridCells cells,
                                const GridOverlap* t, uint number, uint begin, uint end,
                                uint step) {
    const GridEntry entry = {number};
    const int3 bricks = grid_bricks(cells);
    for (uint column = begin; column < end; column += step) {
        const int y = (int)(column % (uint)(t->last.y + 1));
        const int z = (int)(column / (uint)(t->last.y + 1));
        if (!t->is_row && !grid_column_overlaps(t, y, z)) continue;
        for (int x = 0; x <= t->last.x; ++x) {
            if (!t->is_row && !grid_cell_overlaps(t, x, y, z)) continue;
            const int3 cell = t->low + (int3)(x, y, z);
            const int3 brick = cell >> GRID_BRICK_BITS, within = cell & 3;
            const uint list =
                (uint)((brick.z * bricks.y + brick.y) * bricks.x + brick.x) * GRID_BRICK_CELLS +
                (uint)(within.x | within.y << 2 | within.z << 4);
            cellist_insert(entries, list, entry);
        }
    }
}

// One work-item a triangle. Where a triangle may touch many columns of cells, it goes to `parts`
// instead; if that is full, there is enough to do for every work-item as it is.
//
// corners      three a triangle, in units of the grid
// part_count   0 before; may exceed `part_room` afterwards
kernel void grid_insert(CELLIST_LISTS(GridEntry, entries), const GridCells cells,
                        global const GridTriangle* triangles, uint count, global float4* corners,
                        global GridPart* parts, uint part_room, volatile global uint* part_count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const float3 a = cellist_float3(triangles[i].a);
    const float3 b = cellist_float3(triangles[i].b);
    const float3 c = cellist_float3(triangles[i].c);
    corners[3 * i] = (float4)(a * cells.unit, 0.0f);
    corners[3 * i + 1] = (float4)(b * cells.unit, 0.0f);
    corners[3 * i + 2] = (float4)(c * cells.unit, 0.0f);
    const GridEntry entry = {i};
    if (!all(isfinite(a)) || !all(isfinite(b)) || !all(isfinite(c))) {
        cellist_insert(entries, CELLIST_NONE, entry);
        return;
    }
    GridOverlap overlap;
    int reaches_out;
    const int is_near = grid_overlap_begin(&overlap, cells, a, b, c, &reaches_out);
    if (reaches_out) cellist_insert(entries, grid_outside(cells), entry);
    if (!is_near) return;
    const uint columns = grid_columns(&overlap);
    const uint needed = min((columns - 1) / GRID_COLUMNS_PER_PART + 1, GRID_PARTS_MAX);
    // The counter is read first so that it never wraps around.
    if (needed > 1 && *part_count < part_room) {
        const uint first = atomic_add(part_count, needed);
        const int fits = first <= part_room && needed <= part_room - first;
        for (uint part = 0; part < needed && first + part < part_room; ++part) {
            const GridPart shared = {fits ? i : CELLIST_NONE, part, needed};
            parts[first + part] = shared;
        }
        if (fits) return;
    }
    grid_insert_columns(CELLIST_PASS(entries), cells, &overlap, i, 0, columns, 1);
}

// One work-group a part, of any number of work-groups.
kernel void grid_insert_parts(CELLIST_LISTS(GridEntry, entries), const GridCells cells,
                              global const GridTriangle* triangles, global const GridPart* parts,
                              uint part_room, global const uint* part_count) {
    const uint count = min(*part_count, part_room);
    for (uint i = get_group_id(0); i < count; i += get_num_groups(0)) {
        const GridPart part = parts[i];
        if (part.triangle == CELLIST_NONE) continue;
        const GridTriangle triangle = triangles[part.triangle];
        GridOverlap overlap;
        int reaches_out;
        if (!grid_overlap_begin(&overlap, cells, cellist_float3(triangle.a),
                                cellist_float3(triangle.b), cellist_float3(triangle.c),
                                &reaches_out))
            continue;
        grid_insert_columns(CELLIST_PASS(entries), cells, &overlap, part.triangle,
                            part.part + part.parts * get_local_id(0), grid_columns(&overlap),
                            part.parts * get_local_size(0));
    }
}

// One work-item a brick: which of its cells have a list. See walk.clh.
kernel void grid_find_occupied(CELLIST_LISTS(GridEntry, entries), uint bricks,
                               global ulong* occupancy) {
    const uint brick = get_global_id(0);
    if (brick >= bricks) return;
    ulong occupied = 0;
    for (uint i = 0; i < GRID_BRICK_CELLS; ++i) {
        cellist_for_each(entries, brick * GRID_BRICK_CELLS + i, node) {
            occupied |= 1ul << i;
            break;
        }
    }
    occupancy[brick] = occupied;
}

// One work-item a block of bricks: how large the empty cube around each brick is.
kernel void grid_find_empty(const GridCells cells, global ulong* occupancy) {
    const int3 bricks = grid_bricks(cells);
    const int3 blocks = (bricks + 3) >> 2;
    const int i = (int)get_global_id(0);
    if (i >= blocks.x * blocks.y * blocks.z) return;
    global uchar* empty = (global uchar*)(occupancy + bricks.x * bricks.y * bricks.z);
    const int3 low = (int3)(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y)) << 2;
    const int3 end = min(low + 4, bricks);
    ulong any = 0;
    for (int z = low.z; z < end.z; ++z)
        for (int y = low.y; y < end.y; ++y)
            for (int x = low.x; x < end.x; ++x) any |= occupancy[(z * bricks.y + y) * bricks.x + x];
    for (int z = low.z; z < end.z; ++z)
        for (int y = low.y; y < end.y; ++y)
            for (int x = low.x; x < end.x; ++x) {
                const int brick = (z * bricks.y + y) * bricks.x + x;
                empty[brick] = occupancy[brick] ? 0 : any ? GRID_BRICK_BITS : GRID_BLOCK_BITS;
            }
}
