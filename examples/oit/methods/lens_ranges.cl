// SPDX-License-Identifier: MIT
// Spreads the range of each tile to the tiles in its row, or column, that may see its surfaces.
kernel void oit_spread_ranges(global const uint2* ranges, global uint2* spread, const int along_y,
                              const float scale, const float focus) {
    const size_t x = get_global_id(0), y = get_global_id(1), across = get_global_size(0);
    const size_t first = get_global_id(2) * get_global_size(1) * across;
    const int own = along_y ? y : x;
    const int length = along_y ? get_global_size(1) : across;
    const size_t stride = along_y ? across : 1;
    const size_t line = first + (along_y ? x : y * across);
    uint2 result = OIT_NO_RANGE;
    for (int i = 0; i < length; ++i) {
        const uint2 other = ranges[line + i * stride];
        if (other.x > other.y) continue;
        if (((float)abs(i - own) - 1.0f) * OIT_TILE <= oit_circle(other, scale, focus)) {
            result.x = min(result.x, other.x);
            result.y = max(result.y, other.y);
        }
    }
    spread[line + own * stride] = result;
}
