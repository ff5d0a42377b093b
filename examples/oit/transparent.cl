// Pass: shades the samples of transparent surfaces and inserts them into the lists of their pixels.
// normals: 3 floats a vertex. With OIT_OPAQUE, samples behind the opaque depth are left out.
#ifdef OIT_OPAQUE
#define RASTER_TARGET                                                                              \
    CELLIST_LISTS(Fragment, fragments), const Look kernel_look, global const float *normals,       \
        global const uint *depth_bits
#define RASTER_TARGET_PASS CELLIST_PASS(fragments), kernel_look, normals, depth_bits
#else
#define RASTER_TARGET                                                                              \
    CELLIST_LISTS(Fragment, fragments), const Look kernel_look, global const float *normals
#define RASTER_TARGET_PASS CELLIST_PASS(fragments), kernel_look, normals
#endif

static inline void raster_emit(RASTER_TARGET, const View* view, const RasterSample* sample) {
#ifdef OIT_OPAQUE
    if (!(sample->depth < as_float(depth_bits[(size_t)sample->y * view->width + sample->x])))
        return;
#endif
    const Look look = kernel_look;
    const float3 normal = sample->weight[0] * vload3(sample->corner[0], normals) +
                          sample->weight[1] * vload3(sample->corner[1], normals) +
                          sample->weight[2] * vload3(sample->corner[2], normals);
    const float3 colour =
        oit_shade_surface(&look, normal, sample->front, oit_ray(view, sample->x, sample->y));
    const Fragment fragment = {sample->depth, colour.x, colour.y, colour.z};
    cellist_insert(fragments, cellist_cell2(fragments, sample->x, sample->y), fragment);
}
