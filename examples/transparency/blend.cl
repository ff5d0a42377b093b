// SPDX-License-Identifier: MIT
// The second pass: blends the sorted list of each pixel, front to back, over the background.

#include <cellist/glm.clh>
#include <cellist/lists.clh>

kernel void blend(CELLIST_LISTS(Fragment, fragments), const Surface surface, global float4* image) {
    const uint x = get_global_id(0);
    const uint y = get_global_id(1);

    float3 colour = 0.0f;
    float transmittance = 1.0f;  // the part of the light that still comes through
    cellist_for_each(fragments, cellist_cell2(fragments, x, y), node) {
        const Fragment fragment = cellist_get(fragments, node);
        colour += transmittance * fragment.alpha * cellist_float3(fragment.colour);
        transmittance *= 1.0f - fragment.alpha;
    }
    colour += transmittance * cellist_float3(surface.background);
    image[y * get_global_size(0) + x] = (float4)(colour, 1.0f);
}
