// Projects the vertices of all instances, a work-group for each batch of them. positions: 3 floats a
// vertex.
kernel void raster_transform(global const View* views, global const RasterInstance* instances,
                             global const RasterBatch* batches, global const float* positions,
                             global RasterVertex* vertices) {
    const RasterBatch batch = batches[get_group_id(0)];
    const uint i = batch.first + get_local_id(0);
    if (i >= batch.end) return;
    const float3 p = vload3(i, positions);
    const RasterInstance instance = instances[batch.instance];
    const View view = views[instance.eye];
    vertices[i + instance.projected] = raster_project(&view, &instance, p.x, p.y, p.z);
}
