// SPDX-License-Identifier: MIT
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

#ifdef cl_khr_fp64
#define GRID_REAL2 double2
#define GRID_ROUNDING 0x1p-49
#else
#define GRID_REAL2 float2
#define GRID_ROUNDING 0x1p-20f
#endif

// The line through a and b. The third corner tells which side is outside: the sign of the area
// would be wrong for needles. Where rounding hides the side, the lines keep the direction of the
// corners, so that two that coincide bound a strip.
static GridEdge grid_edge(GRID_REAL2 a, GRID_REAL2 b, GRID_REAL2 third, GRID_REAL margin) {
    GRID_REAL2 n = (GRID_REAL2)(a.y - b.y, b.x - a.x);
    const GRID_REAL2 apart = third - a;
    const GRID_REAL size = fabs(n.x) + fabs(n.y);
    if (dot(n, apart) < -size * (fabs(apart.x) + fabs(apart.y)) * (GRID_REAL)GRID_ROUNDING) n = -n;
    const GRID_REAL offset =
        fmax(n.x, (GRID_REAL)0) + fmax(n.y, (GRID_REAL)0) - dot(n, a) + size * margin;
    // The size may leave the range of floats; the cell then counts as inside.
    const float scale = 1.0f / (float)size;
    GridEdge edge;
    edge.n = (float2)((float)(n.x * scale), (float)(n.y * scale));
    edge.offset = (float)(offset * scale);
    return edge;
}

static int grid_is_beyond(GridEdge edge, float p, float q) {
    return edge.n.x * p + edge.n.y * q + edge.offset < 0.0f;
}

// False where the triangle does not come near the grid. `reaches_out` tells whether it reaches out
// of the grid.
//
// What is the same for all cells is computed in double, because corners may be far away. Each test
// of a cell is in float, whose rounding takes less than an eighth of GRID_MARGIN.
static int grid_overlap_begin(GridOverlap* t, const GridCells cells, float3 a, float3 b, float3 c,
                              int* reaches_out) {
    const float3 in_cells[3] = {grid_in_cells(cells, a), grid_in_cells(cells, b),
                                grid_in_cells(cells, c)};
    const float3 extent = convert_float3(grid_extent(cells));
    const float3 low = fmin(in_cells[0], fmin(in_cells[1], in_cells[2]));
    const float3 high = fmax(in_cells[0], fmax(in_cells[1], in_cells[2]));
    *reaches_out = !all(low >= -GRID_OUTSIDE_ERROR && high <= extent + GRID_OUTSIDE_ERROR);
    if (!all(high >= -GRID_MARGIN && low <= extent + GRID_MARGIN)) return 0;
    t->low = convert_int3(fmax(low - GRID_MARGIN, 0.0f));
    t->low = min(t->low, convert_int3(extent) - 1);
    t->last = convert_int3(fmin(high + GRID_MARGIN, extent - 1.0f)) - t->low;
    t->is_row = (t->last.x == 0) + (t->last.y == 0) + (t->last.z == 0) >= 2;
    if (t->is_row) return 1;

    const GRID_REAL3 shift =
        grid_in_units(cells, (float3)(cells.origin[0], cells.origin[1], cells.origin[2]));
    const GRID_REAL3 corner = GRID_TO_REAL3(convert_float3(t->low));
    const GRID_REAL scale = cells.cells_per_unit;
    const GRID_REAL3 p = (grid_in_units(cells, a) - shift) * scale - corner;
    const GRID_REAL3 q = (grid_in_units(cells, b) - shift) * scale - corner;
    const GRID_REAL3 r = (grid_in_units(cells, c) - shift) * scale - corner;
    const GRID_REAL3 pq = q - p, pr = r - p;
    const GRID_REAL3 n = cross(pq, pr);
    const GRID_REAL3 far = fmax(fabs(p), fmax(fabs(q), fabs(r)));
    const GRID_REAL reach = fmax(far.x, fmax(far.y, far.z)) + 1;
    const GRID_REAL margin = 1.25f * GRID_MARGIN + reach * GRID_ROUNDING;
    const GRID_REAL3 pq_size = fabs(pq), pr_size = fabs(pr);
    const GRID_REAL n_size = fabs(n.x) + fabs(n.y) + fabs(n.z);
    const GRID_REAL slack = n_size * margin + (pq_size.x + pq_size.y + pq_size.z) *
                                                  (pr_size.x + pr_size.y + pr_size.z) * reach *
                                                  GRID_ROUNDING;
    const GRID_REAL distance = -dot(n, p);
    const GRID_REAL3 least = fmin(n, (GRID_REAL3)(0)), most = fmax(n, (GRID_REAL3)(0));
    const float n_scale = 1.0f / (float)n_size;
    t->n = (float3)((float)(n.x * n_scale), (float)(n.y * n_scale), (float)(n.z * n_scale));
    t->under = (float)((distance + least.x + least.y + least.z - slack) * n_scale);
    t->above = (float)((distance + most.x + most.y + most.z + slack) * n_scale);
    const GRID_REAL3 corners[5] = {p, q, r, p, q};
    for (int i = 0; i < 3; ++i) {
        const GRID_REAL3 begin = corners[i], end = corners[i + 1], third = corners[i + 2];
        t->xy[i] = grid_edge(begin.xy, end.xy, third.xy, margin);
        t->yz[i] = grid_edge(begin.yz, end.yz, third.yz, margin);
        t->zx[i] = grid_edge(begin.zx, end.zx, third.zx, margin);
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
static void grid_insert_columns(CELLIST_LISTS(uint, entries), const GridCells cells,
                                const GridOverlap* t, uint number, uint begin, uint end,
                                uint step) {
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
            cellist_insert(entries, list, number);
        }
    }
}

// One work-item a triangle. Where a triangle may touch many columns of cells, it goes to `parts`
// instead; if that is full, there is enough to do for every work-item as it is.
//
// corners      three a triangle, in units of the grid; NaN beyond GRID_CORNER_MAX
// part_count   0 before; may exceed `part_room` afterwards
kernel void grid_insert(CELLIST_LISTS(uint, entries), const GridCells cells,
                        global const GridTriangle* triangles, uint count, global float4* corners,
                        global GridPart* parts, uint part_room, volatile global uint* part_count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const float3 a = cellist_float3(triangles[i].a);
    const float3 b = cellist_float3(triangles[i].b);
    const float3 c = cellist_float3(triangles[i].c);
    const float3 points[3] = {a * cells.unit, b * cells.unit, c * cells.unit};
    for (int k = 0; k < 3; ++k) {
        const int is_close = all(fabs(points[k]) <= GRID_CORNER_MAX);
        corners[3 * i + k] = (float4)(is_close ? points[k] : (float3)(NAN), 0.0f);
    }
    if (!all(isfinite(a)) || !all(isfinite(b)) || !all(isfinite(c))) {
        cellist_insert(entries, CELLIST_NONE, i);
        return;
    }
    GridOverlap overlap;
    int reaches_out;
    const int is_near = grid_overlap_begin(&overlap, cells, a, b, c, &reaches_out);
    if (reaches_out) cellist_insert(entries, grid_outside(cells), i);
    if (!is_near) return;
    const uint columns = grid_columns(&overlap);
    const uint needed = min((columns - 1) / GRID_COLUMNS_PER_PART + 1, GRID_PARTS_MAX);
    // The counter is read first so that it never wraps around.
    if (columns > GRID_COLUMNS_ALONE && *part_count < part_room) {
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
kernel void grid_insert_parts(CELLIST_LISTS(uint, entries), const GridCells cells,
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
kernel void grid_find_occupied(CELLIST_LISTS(uint, entries), uint bricks, global ulong* occupancy) {
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
