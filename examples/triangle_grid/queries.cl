// Any-hit queries: one segment a work-item.
//
// ends     two points a segment: x, y, z
// hits     1 where the segment meets a triangle, 0 elsewhere
kernel void ask(GRID_SCENE(scene), global const float4* ends, uint count, global uint* hits) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    hits[i] = (uint)grid_any_hit(GRID_PASS(scene), ends[2 * i].xyz, ends[2 * i + 1].xyz);
}
