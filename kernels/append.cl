// SPDX-License-Identifier: MIT
// Kernels that appends need besides those of the user.
//
// One work-item per cell, except for cellist_save_counters; ranges are padded to whole work-groups.
#include <cellist/lists.clh>

// Inserts all records of other lists of the same shape.
kernel void cellist_insert_lists(CELLIST_LISTS(CELLIST_RECORD, lists),
                                 CELLIST_LISTS(CELLIST_RECORD, from)) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(from)) return;
    cellist_for_each(from, cell, node) cellist_insert(lists, cell, cellist_get(from, node));
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
