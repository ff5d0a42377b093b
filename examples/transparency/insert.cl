// SPDX-License-Identifier: MIT
// The first pass: each fragment of each triangle goes into the list of its pixel.
//
// The rasteriser calls raster_emit() for every pixel that a triangle covers, in any order and
// from many work-items at once. RASTER_TARGET lists the parameters that this pass adds to the
// rasteriser's kernels; RASTER_TARGET_PASS lists the same as arguments.

#include <cellist/glm.clh>

#define RASTER_TARGET                                                                              \
    CELLIST_LISTS(Fragment, fragments), global const float *normals, const Surface surface
#define RASTER_TARGET_PASS CELLIST_PASS(fragments), normals, surface

static inline void raster_emit(RASTER_TARGET, const View* view,
                               global const RasterInstance* instance, uint piece,
                               const RasterFragment* covered) {
    // The normal between the corners. The mesh stays in its place, so its normals do, too.
    float3 normal = 0.0f;
    for (int i = 0; i < 3; ++i) normal += covered->weight[i] * vload3(covered->corner[i], normals);
    normal *= rsqrt(fmax(dot(normal, normal), 1e-12f));

    // Both sides are lit alike, so only absolute values of cosines count.
    const float3 ray = normalize(vload3(0, view->ray_origin) + covered->x * vload3(0, view->ray_x) +
                                 covered->y * vload3(0, view->ray_y));
    const float3 light = cellist_float3(surface.light);
    const float facing_light = fabs(dot(normal, light));
    const float facing_eye = fmax(fabs(dot(normal, ray)), 0.2f);
    const float shine = pow(fabs(dot(normal, normalize(light - ray))), 64.0f);
    const float3 colour =
        (0.2f + 0.8f * facing_light) * cellist_float3(surface.colour) + 0.6f * shine;

    Fragment fragment;
    fragment.depth = covered->depth;
    fragment.colour = (cellist_vec3){colour.x, colour.y, colour.z};
    // At an angle, more light stays in the surface.
    fragment.alpha = 1.0f - pow(1.0f - surface.alpha, 1.0f / facing_eye);
    cellist_insert(fragments, cellist_cell2(fragments, covered->x, covered->y), fragment);
}
