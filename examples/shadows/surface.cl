// SPDX-License-Identifier: MIT
// Pass: the surface of the fragment that has the least key.
#define RASTER_TARGET SURFACES_TARGET
#define RASTER_TARGET_PASS SURFACES_TARGET_PASS

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    const int pixel = covered->y * view->width + covered->x;
    const ulong key =
        fragment_key(&placed_meshes[instance->tag], covered, mesh_positions, piece, from);
    if (key == SURFACES_NO_KEY || key != keys[pixel]) return;
    const PlacedMesh placed = placed_meshes[instance->tag];
    const float3 position = fragment_position(placed, covered, mesh_positions);
    float3 n = 0.0f;
    for (int i = 0; i < 3; ++i) n += covered->weight[i] * vload3(covered->corner[i], mesh_normals);
    n = (float3)(dot(vload3(0, instance->normal_x), n), dot(vload3(0, instance->normal_y), n),
                 dot(vload3(0, instance->normal_z), n));
    // Both sides are lit: the normal is of the side that the viewer sees. The plane of the triangle
    // tells which; at a silhouette, an interpolated normal may point away from the viewer.
    const float3 seen_along = from.is_spot ? position - from.position.xyz : from.axis.xyz;
    float3 plane = plane_normal(placed, covered, mesh_positions);
    if (dot(plane, n) < 0.0f) plane = -plane;
    if (dot(plane, seen_along) > 0.0f) n = -n;
    Surface surface;
    surface.position = (float4)(position, 1.0f);
    surface.normal = (float4)(n * rsqrt(fmax(dot(n, n), 1e-30f)), 0.0f);
    surface.albedo = placed.albedo;
    surfaces[pixel] = surface;
}
