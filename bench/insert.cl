// SPDX-License-Identifier: MIT
// Inserts of `count` records, one from each work-item; launched over whole work-groups.
#include <cellist/lists.clh>

kernel void insert(CELLIST_LISTS(RECORD, lists), uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(lists, bench_cell(i, cellist_cells(lists), distribution), bench_record(i));
}

kernel void insert_stored(CELLIST_LISTS(RECORD, lists), global const uint* cells,
                          global const RECORD* records, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(lists, cells[i], records[i]);
}

// The baseline: as in the papers, one counter for all nodes, and every work-item alone.
kernel void insert_with_one_counter(CELLIST_LISTS(RECORD, lists), uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const uint node = atomic_inc(&lists_shards[0].allocated);
    if (node >= count) return;
    const uint cell = bench_cell(i, cellist_cells(lists), distribution);
    lists_nodes[node].record = bench_record(i);
    lists_nodes[node].next = atomic_xchg(&lists_heads[cell], node);
}
