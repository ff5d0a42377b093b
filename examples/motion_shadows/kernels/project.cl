// SPDX-License-Identifier: MIT
// Projects vertices to a view. A vertex becomes NaN if it is infinite, NaN, or so far away that
// squares of edge functions would overflow.
static float4 project_position(const View view, float3 position) {
    const float4 p = (float4)(position, 1.0f);
    const float4 v = (float4)(dot(view.row_x, p), dot(view.row_y, p), dot(view.row_w, p),
                              dot(view.row_depth, p));
    const float pixels = (float)max(view.width, view.height);
    return all(fabs(v) < 0x1p30f) && fabs(v.z) * pixels < 0x1p30f ? v : (float4)(NAN);
}

// One work-item a vertex.
kernel void project_vertices(const View view, global const float* begin, global const float* end,
                             uint count, global MovingVertex* vertices) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    vertices[i].begin = project_position(view, vload3(i, begin));
    vertices[i].end = project_position(view, vload3(i, end));
}
