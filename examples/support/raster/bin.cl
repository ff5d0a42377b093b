// Puts the pieces of large and clipped triangles into the lists of the screen tiles that they
// touch. positions: 3 floats a vertex; indices: 3 a triangle.

// True where no pixel centre of the tile is covered, because all lie outside of one edge.
static bool raster_tile_missed(const RasterTriangle* t, int tile_x, int tile_y) {
    const int last = RASTER_TILE_PIXELS - 1;
    const int x = tile_x * RASTER_TILE_PIXELS, y = tile_y * RASTER_TILE_PIXELS;
    bool missed = false;
    for (int i = 0; i < 3; ++i) {
        const int corner_x = raster_step_x(t, i) > 0 ? x + last : x;
        const int corner_y = raster_step_y(t, i) > 0 ? y + last : y;
        missed = missed || raster_edge(t, i, corner_x, corner_y) < raster_bias(t, i);
    }
    return missed;
}

static void raster_bin_piece(CELLIST_LISTS(RasterBinned, bins), RasterTriangle* t, uint piece) {
    if (!raster_visible(t) || !raster_orient(t)) return;
    const RasterBinned binned = {t->index, piece};
    for (int y = t->y_begin / RASTER_TILE_PIXELS; y * RASTER_TILE_PIXELS < t->y_end; ++y)
        for (int x = t->x_begin / RASTER_TILE_PIXELS; x * RASTER_TILE_PIXELS < t->x_end; ++x)
            if (!raster_tile_missed(t, x, y))
                cellist_insert(bins, cellist_cell2(bins, x, y), binned);
}

kernel void raster_bin(CELLIST_LISTS(RasterBinned, bins), const View kernel_view,
                       global const RasterVertex* vertices, global const float* positions,
                       global const uint* indices, uint count) {
    const uint index = get_global_id(0);
    if (index >= count) return;
    const View view = kernel_view;
    RasterTriangle t;
    int outside_all, outside_any;
    raster_load(vertices, indices, index, &t, &outside_all, &outside_any);
    if (outside_all) return;
    if (!outside_any) {
        raster_bound(&view, &t);
        if (!raster_small(&t)) raster_bin_piece(CELLIST_PASS(bins), &t, 0);
        return;
    }
    RasterPolygon polygon;
    raster_clip_triangle(&view, positions, &t, &polygon);
    for (int piece = 0; piece + 2 < polygon.count; ++piece) {
        raster_piece(&view, &polygon, piece, &t);
        raster_bound(&view, &t);
        raster_bin_piece(CELLIST_PASS(bins), &t, piece);
    }
}
