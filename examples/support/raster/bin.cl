// Puts the pieces of large and clipped triangles into the lists of the screen tiles that they
// touch: (tiles across) x (tiles down) x (views) of them.

// True where no sample in the tile is covered, because all lie outside of one edge.
static bool raster_tile_missed(const RasterTriangle* t, int tile_x, int tile_y) {
    const int reach = RASTER_SAMPLES == 1 ? 0 : RASTER_REACH;
    const int left = raster_centre(tile_x * RASTER_TILE_PIXELS) - reach;
    const int top = raster_centre(tile_y * RASTER_TILE_PIXELS) - reach;
    const int side = (RASTER_TILE_PIXELS - 1) * RASTER_SUBPIXELS + 2 * reach;
    bool missed = false;
    for (int i = 0; i < 3; ++i) {
        const int x = raster_dy(t, i) < 0 ? left + side : left;
        const int y = raster_dx(t, i) > 0 ? top + side : top;
        missed = missed || raster_edge(t, i, x, y) < raster_bias(t, i);
    }
    return missed;
}

static void raster_bin_piece(CELLIST_LISTS(RasterBinned, bins), RasterTriangle* t, uint eye,
                             uint triangle, uint piece) {
    if (!raster_visible(t) || !raster_orient(t)) return;
    const RasterBinned binned = {triangle, piece};
    for (int y = t->y_begin / RASTER_TILE_PIXELS; y * RASTER_TILE_PIXELS < t->y_end; ++y)
        for (int x = t->x_begin / RASTER_TILE_PIXELS; x * RASTER_TILE_PIXELS < t->x_end; ++x)
            if (!raster_tile_missed(t, x, y))
                cellist_insert(bins, cellist_cell3(bins, x, y, eye), binned);
}

kernel void raster_bin(CELLIST_LISTS(RasterBinned, bins), RASTER_SCENE) {
    const uint triangle = get_global_id(0);
    RasterTriangle t;
    int outside_all, outside_any;
    if (!raster_load(RASTER_SCENE_PASS, triangle, &t, &outside_all, &outside_any)) return;
    if (outside_all) return;
    const uint eye = instances[t.instance].eye;
    const View view = views[eye];
    if (!outside_any) {
        raster_bound(&view, &t);
        if (!raster_small(&t)) raster_bin_piece(CELLIST_PASS(bins), &t, eye, triangle, 0);
        return;
    }
    RasterPolygon polygon;
    raster_clip_triangle(RASTER_SCENE_PASS, &view, &t, &polygon);
    for (int piece = 0; piece + 2 < polygon.count; ++piece) {
        raster_piece(&view, &polygon, piece, &t);
        raster_bound(&view, &t);
        raster_bin_piece(CELLIST_PASS(bins), &t, eye, triangle, piece);
    }
}
