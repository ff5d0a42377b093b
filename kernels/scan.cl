// SPDX-License-Identifier: MIT
// Sums and prefix sums of the counts of all cells, in tiles.
//
//   heads     the counts of the cells, from counts_at on
//   offsets   cells + 1   out: where lists with these counts begin, none over `capacity`. May be
//                         heads, even in the place of the counts
//   kept      cells + 1   the offsets of lists that keep their lengths where the capacity is too
//                         small; the counts include these lists. Any buffer if `keeps` is 0
//   sums      tiles     the sum of min(count, limit) over a tile, in 64 bits; then, in its place,
//                       the sum of all tiles before it
//   hashes    tiles     the sum of a hash of each cell and its count
//   maxima    tiles     the largest count of a tile
//   totals    3         out: the sum of min(count, limit) over all cells, the largest count, and
//                       the sum of the hashes
//
// A work-group of CELLIST_SCAN_GROUP items has a tile of CELLIST_SCAN_GROUP * CELLIST_SCAN_CELLS
// cells, and there are cells / that + 1 tiles. One work-group sums up the tiles. Barriers stand in
// uniform control flow.

// The host defines CELLIST_SCAN_GROUP, the work-items of a group; a power of two.
// Cells of a work-item. As in cell_scan.cpp.
#define CELLIST_SCAN_CELLS 16

// A hash of a cell and its count (the finaliser of MurmurHash3), so that the sum changes if a count
// moves to another cell. Empty cells add nothing.
static inline ulong cellist_count_hash(uint cell, uint count) {
    ulong hash = ((ulong)cell << 32) | count;
    hash = (hash ^ hash >> 33) * 0xFF51AFD7ED558CCDul;
    hash = (hash ^ hash >> 33) * 0xC4CEB9FE1A85EC53ul;
    return hash ^ hash >> 33;
}

kernel __attribute__((reqd_work_group_size(CELLIST_SCAN_GROUP, 1, 1))) void cellist_tile_sums(
    global const uint* heads, uint counts_at, uint cells, uint limit, global ulong* sums,
    global ulong* hashes, global uint* maxima) {
    local ulong group_sums[CELLIST_SCAN_GROUP];
    local ulong group_hashes[CELLIST_SCAN_GROUP];
    local uint group_maxima[CELLIST_SCAN_GROUP];
    const uint item = get_local_id(0);
    const ulong first = (ulong)get_group_id(0) * (CELLIST_SCAN_GROUP * CELLIST_SCAN_CELLS) + item;
    ulong sum = 0;
    ulong hash = 0;
    uint maximum = 0;
    for (uint i = 0; i < CELLIST_SCAN_CELLS; ++i) {
        const ulong cell = first + i * CELLIST_SCAN_GROUP;
        const uint count = cell < cells ? heads[counts_at + cell] : 0;
        sum += min(count, limit);
        if (count != 0) hash += cellist_count_hash((uint)cell, count);
        maximum = max(maximum, count);
    }
    group_sums[item] = sum;
    group_hashes[item] = hash;
    group_maxima[item] = maximum;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint width = CELLIST_SCAN_GROUP / 2; width > 0; width /= 2) {
        if (item < width) {
            group_sums[item] += group_sums[item + width];
            group_hashes[item] += group_hashes[item + width];
            group_maxima[item] = max(group_maxima[item], group_maxima[item + width]);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (item == 0) {
        sums[get_group_id(0)] = group_sums[0];
        hashes[get_group_id(0)] = group_hashes[0];
        maxima[get_group_id(0)] = group_maxima[0];
    }
}

// The sum of `value` over the work-items up to this one.
static inline ulong cellist_group_scan(local ulong* sums, ulong value) {
    const uint item = get_local_id(0);
    sums[item] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint step = 1; step < CELLIST_SCAN_GROUP; step *= 2) {
        const ulong before = item >= step ? sums[item - step] : 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        sums[item] += before;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    return sums[item];
}

// One work-group.
kernel __attribute__((reqd_work_group_size(CELLIST_SCAN_GROUP, 1, 1))) void cellist_tile_starts(
    global ulong* sums, global const ulong* hashes, global const uint* maxima, uint tiles,
    global ulong* totals) {
    local ulong group_sums[CELLIST_SCAN_GROUP];
    local ulong group_hashes[CELLIST_SCAN_GROUP];
    local uint group_maxima[CELLIST_SCAN_GROUP];
    const uint item = get_local_id(0);
    ulong before = 0;
    ulong hash = 0;
    uint maximum = 0;
    for (uint first = 0; first < tiles; first += CELLIST_SCAN_GROUP) {
        const uint tile = first + item;
        const ulong own = tile < tiles ? sums[tile] : 0;
        const ulong up_to = cellist_group_scan(group_sums, own);
        if (tile < tiles) {
            sums[tile] = before + up_to - own;
            hash += hashes[tile];
            maximum = max(maximum, maxima[tile]);
        }
        before += group_sums[CELLIST_SCAN_GROUP - 1];
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    group_hashes[item] = hash;
    group_maxima[item] = maximum;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item != 0) return;
    for (uint i = 1; i < CELLIST_SCAN_GROUP; ++i) {
        hash += group_hashes[i];
        maximum = max(maximum, group_maxima[i]);
    }
    totals[0] = before;
    totals[1] = maximum;
    totals[2] = hash;
}

kernel __attribute__((reqd_work_group_size(CELLIST_SCAN_GROUP, 1, 1))) void cellist_tile_offsets(
    global const uint* heads, uint counts_at, uint cells, global const ulong* sums, uint capacity,
    global const uint* kept, uint keeps, global uint* offsets) {
    local ulong group_sums[CELLIST_SCAN_GROUP];
    const uint item = get_local_id(0);
    const ulong first = ((ulong)get_group_id(0) * CELLIST_SCAN_GROUP + item) * CELLIST_SCAN_CELLS;
    ulong sum = 0;
    for (uint i = 0; i < CELLIST_SCAN_CELLS; ++i)
        if (first + i < cells) sum += heads[counts_at + first + i];
    ulong at = sums[get_group_id(0)] + cellist_group_scan(group_sums, sum) - sum;
    const uint room = capacity - (keeps ? kept[cells] : 0);
    for (uint i = 0; i < CELLIST_SCAN_CELLS; ++i) {
        // The cell after the last takes the end of the last list.
        if (first + i > cells) break;
        const uint count = first + i < cells ? heads[counts_at + first + i] : 0;
        const uint kept_before = keeps ? kept[first + i] : 0;
        offsets[first + i] = kept_before + (uint)min(at - kept_before, (ulong)room);
        at += count;
    }
}
