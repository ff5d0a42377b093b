// Sums and prefix sums of the counts of all cells, in blocks.
//
//   heads     the counts of the cells, from counts_at on; cellist_block_offsets writes the offsets
//             of the lists to its begin: cells + 1, none over `capacity`
//   sums      blocks    out: the sum of min(count, limit) over a block, in 64 bits
//   maxima    blocks    out: the largest count of a block
//   starts    blocks    the sum of all blocks before a block
//
// A work-group of CELLIST_SCAN_GROUP items has a block of CELLIST_SCAN_GROUP * CELLIST_SCAN_CELLS
// cells, and there are cells / that + 1 blocks; the host sums them up. Barriers stand in uniform control flow.

// Work-items of a group; a power of two. As in cell_scan.cpp.
#define CELLIST_SCAN_GROUP 256
// Cells of a work-item.
#define CELLIST_SCAN_CELLS 16

kernel __attribute__((reqd_work_group_size(CELLIST_SCAN_GROUP, 1, 1))) void cellist_block_sums(
    global const uint* heads, uint counts_at, uint cells, uint limit, global ulong* sums,
    global uint* maxima) {
    local ulong group_sums[CELLIST_SCAN_GROUP];
    local uint group_maxima[CELLIST_SCAN_GROUP];
    const uint item = get_local_id(0);
    const ulong first = (ulong)get_group_id(0) * (CELLIST_SCAN_GROUP * CELLIST_SCAN_CELLS) + item;
    ulong sum = 0;
    uint maximum = 0;
    for (uint i = 0; i < CELLIST_SCAN_CELLS; ++i) {
        const ulong cell = first + i * CELLIST_SCAN_GROUP;
        const uint count = cell < cells ? heads[counts_at + cell] : 0;
        sum += min(count, limit);
        maximum = max(maximum, count);
    }
    group_sums[item] = sum;
    group_maxima[item] = maximum;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint width = CELLIST_SCAN_GROUP / 2; width > 0; width /= 2) {
        if (item < width) {
            group_sums[item] += group_sums[item + width];
            group_maxima[item] = max(group_maxima[item], group_maxima[item + width]);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (item == 0) {
        sums[get_group_id(0)] = group_sums[0];
        maxima[get_group_id(0)] = group_maxima[0];
    }
}

kernel __attribute__((reqd_work_group_size(CELLIST_SCAN_GROUP, 1, 1))) void cellist_block_offsets(
    global uint* heads, uint counts_at, uint cells, global const ulong* starts, uint capacity) {
    local ulong group_sums[CELLIST_SCAN_GROUP];
    const uint item = get_local_id(0);
    const ulong first = ((ulong)get_group_id(0) * CELLIST_SCAN_GROUP + item) * CELLIST_SCAN_CELLS;
    ulong sum = 0;
    for (uint i = 0; i < CELLIST_SCAN_CELLS; ++i)
        if (first + i < cells) sum += heads[counts_at + first + i];
    group_sums[item] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint step = 1; step < CELLIST_SCAN_GROUP; step *= 2) {
        const ulong before = item >= step ? group_sums[item - step] : 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        group_sums[item] += before;
        barrier(CLK_LOCAL_MEM_FENCE);
    }

    ulong at = starts[get_group_id(0)] + group_sums[item] - sum;
    for (uint i = 0; i < CELLIST_SCAN_CELLS; ++i) {
        // The cell behind the last takes the end of the last list.
        if (first + i > cells) break;
        heads[first + i] = (uint)min(at, (ulong)capacity);
        if (first + i < cells) at += heads[counts_at + first + i];
    }
}
