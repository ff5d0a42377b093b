// Projects the vertices of a mesh. positions: 3 floats a vertex.
kernel void raster_transform(const View view, global const float* positions, uint count,
                             global RasterVertex* vertices) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const float3 p = vload3(i, positions);
    const View local_view = view;
    vertices[i] = raster_project(&local_view, p.x, p.y, p.z);
}
