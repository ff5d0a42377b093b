// Puts every triangle into the list of each cell that its bounding box comes closer to than
// GRID_MARGIN (Yang et al. 2010, section 4.2). One work-item a triangle; a triangle that is not
// finite is rejected.

// The cells from `low` to `high` along an axis. Both round the same way as the walk.
static int2 grid_cells_between(float low, float high, const GridCells cells, int k) {
    const float origin = cells.origin[k] * cells.unit;
    const float first = (low * cells.unit - origin) * cells.cells_per_unit - GRID_MARGIN;
    const float last = (high * cells.unit - origin) * cells.cells_per_unit + GRID_MARGIN;
    const float most = (float)(cells.extent[k] - 1);
    return (int2)((int)clamp(floor(first), 0.0f, most), (int)clamp(floor(last), 0.0f, most));
}

kernel void grid_insert(CELLIST_LISTS(GridEntry, entries), const GridCells cells,
                        global const GridTriangle* triangles, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const GridEntry entry = {i};
    const float3 a = cellist_float3(triangles[i].a);
    const float3 b = cellist_float3(triangles[i].b);
    const float3 c = cellist_float3(triangles[i].c);
    if (!all(isfinite(a)) || !all(isfinite(b)) || !all(isfinite(c))) {
        cellist_insert(entries, CELLIST_NONE, entry);
        return;
    }
    const float3 low = fmin(a, fmin(b, c));
    const float3 high = fmax(a, fmax(b, c));
    const int2 xs = grid_cells_between(low.x, high.x, cells, 0);
    const int2 ys = grid_cells_between(low.y, high.y, cells, 1);
    const int2 zs = grid_cells_between(low.z, high.z, cells, 2);
    for (int z = zs.x; z <= zs.y; ++z)
        for (int y = ys.x; y <= ys.y; ++y)
            for (int x = xs.x; x <= xs.y; ++x)
                cellist_insert(entries, cellist_cell3(entries, x, y, z), entry);
}
