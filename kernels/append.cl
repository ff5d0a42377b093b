// SPDX-License-Identifier: MIT
// Kernels that appends need besides those of the user.
//
// One work-item per cell, unless a kernel says otherwise; ranges are padded to whole work-groups.
#include <cellist/lists.clh>

// Inserts all records of other lists of the same shape.
kernel void cellist_insert_lists(CELLIST_LISTS(CELLIST_RECORD, lists),
                                 CELLIST_LISTS(CELLIST_RECORD, from)) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(from)) return;
    cellist_for_each(from, cell, node) cellist_insert(lists, cell, cellist_get(from, node));
}

// Makes the lengths of contiguous lists the counts of counted lists, and clears the counters.
//
// At least one work-item per cell and per counter.
kernel void cellist_count_lists(CELLIST_LISTS(CELLIST_RECORD, lists),
                                CELLIST_LISTS(CELLIST_RECORD, from)) {
    const uint cell = get_global_id(0);
    const cellist_shard none = {0};
    if (cell <= 1u << cellist_view_of(lists).shard_bits) lists_shards[cell] = none;
    if (cell >= cellist_cells(from)) return;
    *cellist_cell_count(lists_heads, cellist_view_of(lists), cell) = cellist_length(from, cell);
}

// The last cell from `cell` on whose list begins at node i or before it. The steps double: the cell
// is often close.
static inline uint cellist_cell_of_node(global const uint* offsets, uint cells, uint cell, uint i) {
    uint step = 1;
    for (; step < cells - cell && offsets[cell + step] <= i; step *= 2) cell += step;
    uint end = cell + min(step, cells - cell);
    while (end - cell > 1) {
        const uint middle = cell + (end - cell) / 2;
        if (offsets[middle] <= i)
            cell = middle;
        else
            end = middle;
    }
    return cell;
}

// Copies contiguous lists to the begin of other contiguous lists, as far as these go.
//
// On processors, one work-item per CELLIST_MOVE_TILE records, however long the lists are. Elsewhere
// CELLIST_MOVE_LANES, which move consecutive records at a time, to read and write whole lines.
#if CELLIST_ONE_THREAD_PER_WORK_GROUP
#define CELLIST_LANES 1u
#else
#define CELLIST_LANES CELLIST_MOVE_LANES
#endif

kernel void cellist_move_lists(CELLIST_LISTS(CELLIST_RECORD, lists),
                               CELLIST_LISTS(CELLIST_RECORD, from)) {
    const uint cells = cellist_cells(from);
    global const uint* offsets = (global const uint*)from_heads;
    global const uint* heads = (global const uint*)lists_heads;
    const ulong item = get_global_id(0);
    const ulong first = item / CELLIST_LANES * CELLIST_MOVE_TILE;
    const uint end = (uint)min(first + CELLIST_MOVE_TILE, (ulong)offsets[cells]);
    uint cell = 0;
    for (ulong i = first + item % CELLIST_LANES; i < end; i += CELLIST_LANES) {
        const uint node = (uint)i;
        cell = cellist_cell_of_node(offsets, cells, cell, node);
        const uint to = heads[cell] + (node - offsets[cell]);
        if (to < heads[cell + 1]) cellist_get(lists, to) = cellist_get(from, node);
    }
}

// Saves the counters of linked lists, then clears the counts of records that are not stored.
//
//   saved   as the shards of the lists   out
//
// One work-item per element.
kernel void cellist_save_counters(CELLIST_LISTS(CELLIST_RECORD, lists),
                                  volatile global cellist_shard* saved) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint shards = (1u << lists_view.shard_bits) + 1u;
    const uint blocks = lists_view.thread_slots;
    // A table of threads, in two words each, follows the blocks.
    const uint elements = shards + blocks + blocks * 8u / (uint)sizeof(cellist_shard);
    const uint i = get_global_id(0);
    if (i >= elements) return;
    cellist_shard shard = lists_shards[i];
    saved[i] = shard;
    if (i >= shards) return;
    shard.dropped_low = shard.dropped_high = 0;
    shard.rejected_low = shard.rejected_high = 0;
    shard.late_low = shard.late_high = 0;
    lists_shards[i] = shard;
}

// Makes the first node of each linked list that was allocated when the counters were saved its
// head: inserts put newer nodes before it, and leave its link as it is.
kernel void cellist_rewind_heads(CELLIST_LISTS(CELLIST_RECORD, lists),
                                 volatile global cellist_shard* saved) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint node = lists_heads[cell];
    for (uint step = 0; step < lists_view.pool_nodes && node != CELLIST_NONE; ++step) {
        if (cellist_is_allocated(saved, lists_view, node)) break;
        node = lists_nodes[node].next;
    }
    lists_heads[cell] = node;
}

// Takes the records that were dropped out of the counts of contiguous lists and slots.
kernel void cellist_trim_counts(CELLIST_LISTS(CELLIST_RECORD, lists)) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    volatile global uint* count = cellist_has_mode(lists_view, CELLIST_FIXED)
                                      ? &lists_heads[cell]
                                      : cellist_cell_count(lists_heads, lists_view, cell);
    *count = cellist_length(lists, cell);
}
