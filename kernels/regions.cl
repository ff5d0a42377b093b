// SPDX-License-Identifier: MIT
// Moves records from regions of the partitions into contiguous lists, on GPUs. An insert in mode
// PARTITIONED has left each record in the region of its cell's partition, with the cell after it:
// see counted.clh. A work-group counts a partition in local memory, sorts it there by cell, and
// writes whole lines. After Stehle and Jacobsen, "A Memory Bandwidth-Efficient Hybrid Radix Sort on
// GPUs", SIGMOD 2017, section 4.3.
//
//   partitioned   what was the heads of the insert
//   starts        1 + partitions   the number of records, then where each partition's lists begin
//
// Work-groups have CELLIST_REGION_GROUP items. The host defines
//   CELLIST_REGION_CELLS     cells of a partition: 2^partition_bits
//   CELLIST_REGION_RECORDS   records of a partition that are sorted by a group; a multiple of the
//                            group. The records of a larger one go straight to their lists
//   CELLIST_REGION_STAGED    records in local memory at a time; a multiple of 32
//   CELLIST_RECORD_WORDS     words of a record; 0 if its size is no multiple of 4 bytes
// Barriers stand in uniform control flow.
#include <cellist/lists.clh>

#define CELLIST_NODE_OF(T) CELLIST_NODE_OF_EXPANDED(T)
#define CELLIST_NODE_OF_EXPANDED(T) cellist_node_##T

// What work-items have in arrays stays in registers only where loops are unrolled.
#define CELLIST_UNROLLED _Pragma("unroll")

// The sum of `value` over the work-items before this one. `sums` has one for each.
static inline uint cellist_sum_before(local uint* sums, uint value) {
    const uint item = get_local_id(0);
    sums[item] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint step = 1; step < get_local_size(0); step *= 2) {
        const uint before = item >= step ? sums[item - step] : 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        sums[item] += before;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    const uint before = sums[item] - value;
    barrier(CLK_LOCAL_MEM_FENCE);
    return before;
}

// The sum of `value` over all work-items.
static inline uint cellist_sum_of_all(local uint* sums, uint value) {
    const uint before = cellist_sum_before(sums, value);
    if (get_local_id(0) == get_local_size(0) - 1) sums[0] = before + value;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint sum = sums[0];
    barrier(CLK_LOCAL_MEM_FENCE);
    return sum;
}

// ---- regions ------------------------------------------------------------------------------------
//
// A work-item a partition.

// Where the region of a partition begins: a region has room for an eighth more records than the
// partition's last lists had, and an equal share of what that leaves of `nodes`. heads: of the
// lists.
static inline uint cellist_region_begin(global const uint* heads, uint cells, uint partition_bits,
                                        uint partitions, uint partition, uint nodes) {
    const ulong all = (ulong)heads[cells] * 9 / 8;
    const ulong share = all < nodes ? (nodes - all) / partitions : 0;
    const ulong first = min((ulong)partition << partition_bits, (ulong)cells);
    return (uint)min((ulong)heads[first] * 9 / 8 + share * partition, (ulong)nodes);
}

// Divides `nodes` nodes into regions. One for more than `most` records takes none: a work-group
// would take too long to move them.
kernel void cellist_plan_regions(global const uint* heads, uint cells, uint partition_bits,
                                 uint partitions, uint nodes, uint most, global uint* partitioned) {
    const uint p = get_global_id(0);
    if (p >= partitions) return;
    const uint begin = cellist_region_begin(heads, cells, partition_bits, partitions, p, nodes);
    const uint end = cellist_region_begin(heads, cells, partition_bits, partitions, p + 1, nodes);
    partitioned[p] = begin;
    if (p + 1 == partitions) partitioned[partitions] = end;
    partitioned[partitions + 1 + p * CELLIST_REGION_COUNT_WORDS] =
        end - begin <= most ? 0 : CELLIST_CELL_COUNT_MAX;
}

// The records in the region of a partition: none in one that takes none.
static inline uint cellist_region_length(global const uint* partitioned, uint partitions,
                                         uint partition) {
    const uint count = partitioned[partitions + 1 + partition * CELLIST_REGION_COUNT_WORDS];
    const uint room = partitioned[partition + 1] - partitioned[partition];
    return count < CELLIST_CELL_COUNT_MAX ? min(count, room) : 0;
}

// Where the lists of each partition begin.
kernel __attribute__((reqd_work_group_size(CELLIST_REGION_SCAN_GROUP, 1, 1))) void
cellist_region_starts(global const uint* partitioned, uint partitions, global uint* starts) {
    local uint sums[CELLIST_REGION_SCAN_GROUP];
    const uint item = get_local_id(0), own = get_global_id(0);
    uint before = 0;
    for (uint p = item; p < min(own, partitions); p += CELLIST_REGION_SCAN_GROUP)
        before += cellist_region_length(partitioned, partitions, p);
    const uint length = own < partitions ? cellist_region_length(partitioned, partitions, own) : 0;
    before = cellist_sum_of_all(sums, before) + cellist_sum_before(sums, length);
    if (own < partitions) starts[1 + own] = before;
    if (own == partitions - 1) starts[0] = before + length;
}

// ---- lists --------------------------------------------------------------------------------------

// Replaces the counts of the cells of a partition by where their lists begin in it.
static inline void cellist_scan_counts(local uint* counts, local uint* sums) {
    const uint item = get_local_id(0);
    const uint each = (CELLIST_REGION_CELLS + CELLIST_REGION_GROUP - 1) / CELLIST_REGION_GROUP;
    uint sum = 0;
    for (uint i = item * each; i < min((item + 1) * each, CELLIST_REGION_CELLS); ++i)
        sum += counts[i];
    uint at = cellist_sum_before(sums, sum);
    for (uint i = item * each; i < min((item + 1) * each, CELLIST_REGION_CELLS); ++i) {
        const uint count = counts[i];
        counts[i] = at;
        at += count;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

#define CELLIST_REGION_EACH (CELLIST_REGION_RECORDS / CELLIST_REGION_GROUP)

// The records of a round in local memory. A word more after each 32 spreads columns over the banks.
#if CELLIST_RECORD_WORDS
#define CELLIST_STAGED_TYPE uint
#define CELLIST_STAGED_SIZE (CELLIST_REGION_STAGED * CELLIST_RECORD_WORDS * 33 / 32)
#define CELLIST_STAGED_AT(word) ((word) + (word) / 32)
#else
#define CELLIST_STAGED_TYPE CELLIST_RECORD_TYPE
#define CELLIST_STAGED_SIZE CELLIST_REGION_STAGED
#endif

static inline void cellist_stage(local CELLIST_STAGED_TYPE* staged, uint at,
                                 const CELLIST_RECORD_TYPE* record) {
#if CELLIST_RECORD_WORDS
    CELLIST_UNROLLED
    for (uint w = 0; w < CELLIST_RECORD_WORDS; ++w)
        staged[CELLIST_STAGED_AT(at * CELLIST_RECORD_WORDS + w)] = ((const uint*)record)[w];
#else
    staged[at] = *record;
#endif
}

// Writes the first records in local memory to consecutive nodes.
static inline void cellist_write_staged(local const CELLIST_STAGED_TYPE* staged, uint length,
                                        global CELLIST_RECORD_TYPE* nodes) {
    const uint item = get_local_id(0);
#if CELLIST_RECORD_WORDS
    for (uint w = item; w < length * CELLIST_RECORD_WORDS; w += CELLIST_REGION_GROUP)
        ((global uint*)nodes)[w] = staged[CELLIST_STAGED_AT(w)];
#else
    for (uint i = item; i < length; i += CELLIST_REGION_GROUP) nodes[i] = staged[i];
#endif
}

// One work-group a partition. Writes nothing where the pool has no room for all records.
kernel __attribute__((reqd_work_group_size(CELLIST_REGION_GROUP, 1, 1))) void cellist_move_region(
    CELLIST_LISTS(CELLIST_RECORD, lists),
    global const CELLIST_NODE_OF(CELLIST_RECORD) * restrict nodes,
    global const uint* restrict partitioned, uint partition_bits,
    global const uint* restrict starts) {
    local uint counts[CELLIST_REGION_CELLS];
    local uint sums[CELLIST_REGION_GROUP];
    local CELLIST_STAGED_TYPE staged[CELLIST_STAGED_SIZE];
    const cellist_view lists_view = cellist_view_of(lists);
    const uint item = get_local_id(0);
    const uint partition = get_group_id(0), partitions = get_num_groups(0);
    if (starts[0] > lists_view.pool_nodes) return;
    const uint first_cell = partition << partition_bits;
    const uint cells = min(lists_view.cells - first_cell, (uint)CELLIST_REGION_CELLS);
    const uint length = cellist_region_length(partitioned, partitions, partition);
    const uint start = starts[1 + partition];
    global uint* heads = (global uint*)lists_heads;
    global uint* lengths = (global uint*)cellist_cell_count(lists_heads, lists_view, first_cell);
    nodes += partitioned[partition];

    for (uint i = item; i < CELLIST_REGION_CELLS; i += CELLIST_REGION_GROUP) counts[i] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    CELLIST_RECORD_TYPE records[CELLIST_REGION_EACH];
    uint cell[CELLIST_REGION_EACH];  // then the place among the partition's records
    uint rank[CELLIST_REGION_EACH];
    const bool fits = length <= CELLIST_REGION_RECORDS;
    if (fits) {
        CELLIST_UNROLLED
        for (uint k = 0; k < CELLIST_REGION_EACH; ++k) {
            const uint i = item + k * CELLIST_REGION_GROUP;
            cell[k] = CELLIST_NONE;
            if (i < length) {
                const CELLIST_NODE_OF(CELLIST_RECORD) node = nodes[i];
                records[k] = node.record;
                cell[k] = node.next - first_cell;
            }
        }
        CELLIST_UNROLLED
        for (uint k = 0; k < CELLIST_REGION_EACH; ++k)
            if (cell[k] != CELLIST_NONE) rank[k] = atomic_inc(&counts[cell[k]]);
    } else {
        for (uint i = item; i < length; i += CELLIST_REGION_GROUP)
            atomic_inc(&counts[nodes[i].next - first_cell]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < cells; i += CELLIST_REGION_GROUP) lengths[i] = counts[i];
    barrier(CLK_LOCAL_MEM_FENCE);
    cellist_scan_counts(counts, sums);
    for (uint i = item; i < cells; i += CELLIST_REGION_GROUP)
        heads[first_cell + i] = start + counts[i];
    if (item == 0 && first_cell + cells == lists_view.cells)
        heads[lists_view.cells] = start + length;
    if (!fits) {
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint i = item; i < length; i += CELLIST_REGION_GROUP) {
            const uint at = start + atomic_inc(&counts[nodes[i].next - first_cell]);
            cellist_get(lists, at) = nodes[i].record;
        }
        return;
    }
    CELLIST_UNROLLED
    for (uint k = 0; k < CELLIST_REGION_EACH; ++k)
        if (cell[k] != CELLIST_NONE) cell[k] = counts[cell[k]] + rank[k];
    for (uint begin = 0; begin < length; begin += CELLIST_REGION_STAGED) {
        CELLIST_UNROLLED
        for (uint k = 0; k < CELLIST_REGION_EACH; ++k)
            if (cell[k] - begin < CELLIST_REGION_STAGED)
                cellist_stage(staged, cell[k] - begin, &records[k]);
        barrier(CLK_LOCAL_MEM_FENCE);
        cellist_write_staged(staged, min(length - begin, CELLIST_REGION_STAGED),
                             &cellist_get(lists, start + begin));
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
