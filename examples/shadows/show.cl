// SPDX-License-Identifier: MIT
// One work-item a pixel.
kernel void clear_surfaces(global Surface* surfaces, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    surfaces[i].position = (float4)(0.0f);
    surfaces[i].normal = (float4)(0.0f);
    surfaces[i].albedo = (float4)(0.0f);
}

// One work-item a pixel: how many entries of the grid a ray from the eye passes until it meets the
// surface of the pixel.
kernel void count_passed_entries(GRID_SCENE(scene), global const Surface* seen,
                                 const LightSource eye, const Gather gather, global uint* passed) {
    const uint i = get_global_id(0);
    if (i >= (uint)(gather.width * gather.height)) return;
    uint count = 0;
    GridWalk walk;
    if (seen[i].position.w > 0.0f && grid_walk_begin(&walk, scene_cells, eye.position.xyz,
                                                     seen[i].position.xyz, 1) == GRID_BEGINS)
        for (int leave = 0;; leave = 1) {
            const uint cell =
                grid_walk_find(&walk, scene_occupancy, grid_brick_count(scene_cells), leave);
            if (cell == GRID_NO_CELL) break;
            cellist_for_each(scene_entries, cell, node) ++count;
        }
    passed[i] = count;
}
