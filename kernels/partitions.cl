// SPDX-License-Identifier: MIT
// Moves records from partitions of the cells into contiguous lists. An insert in mode PARTITIONED
// has left each record in a block of its thread for the partition of its cell, with the cell after
// it: see counted.clh. A partition is counted and then moved while a core's cache holds it. After
// Polychroniou and Ross, "A Comprehensive Study of Main-Memory Partitioning", SIGMOD 2014.
//
//   thread_slots    of the view of the insert
//   partitioned     what was the heads of the insert
//   starts          1 + partitions   the number of records, then where each partition's lists begin
//
// A processor runs these: a work-item goes through memory in order, and has a thread for itself.
#include <cellist/lists.clh>

#define CELLIST_NODE_OF(T) CELLIST_NODE_OF_EXPANDED(T)
#define CELLIST_NODE_OF_EXPANDED(T) cellist_node_##T

static inline global const cellist_cursor* cellist_cursors(global const uint* partitioned,
                                                           uint thread_slots) {
    return (global const cellist_cursor*)&partitioned[2 * (ulong)thread_slots];
}

// One work-item.
kernel void cellist_partition_starts(global const uint* partitioned, uint thread_slots,
                                     uint partitions, global uint* starts) {
    global const cellist_cursor* cursors = cellist_cursors(partitioned, thread_slots);
    for (uint partition = 0; partition < partitions; ++partition) starts[1 + partition] = 0;
    for (uint slot = 0; slot < thread_slots; ++slot)
        for (uint partition = 0; partition < partitions; ++partition) {
            const cellist_cursor cursor = cursors[(ulong)slot * partitions + partition];
            starts[1 + partition] +=
                cursor.blocks * CELLIST_BLOCK_NODES - (cursor.last - cursor.node);
        }
    uint at = 0;
    for (uint partition = 0; partition < partitions; ++partition) {
        const uint length = starts[1 + partition];
        starts[1 + partition] = at;
        at += length;
    }
    starts[0] = at;
}

// Calls `use` with each node of `partition`: blocks from the last to the first, of one thread after
// the other. Takes the variables of cellist_move_partition.
#define CELLIST_FOR_EACH_PARTITIONED(use)                                                          \
    for (uint slot = 0; slot < thread_slots; ++slot) {                                             \
        const cellist_cursor cursor = cursors[(ulong)slot * partitions + partition];               \
        uint block = cursor.block;                                                                 \
        uint length = CELLIST_BLOCK_NODES - (cursor.last - cursor.node);                           \
        for (uint left = cursor.blocks; left > 0; --left) {                                        \
            global const CELLIST_NODE_OF(CELLIST_RECORD)* node =                                   \
                &nodes[(ulong)block * CELLIST_BLOCK_NODES];                                        \
            for (uint i = 0; i < length; ++i, ++node) use(node);                                   \
            block = chain[block];                                                                  \
            length = CELLIST_BLOCK_NODES;                                                          \
        }                                                                                          \
    }

#define CELLIST_LINE_BYTES 64
#define CELLIST_COUNT(node) ++counts[node->next]
#define CELLIST_MOVE(node) cellist_get(lists, counts[node->next]++) = node->record

// One work-item a partition. Writes nothing where the pool has no room for all records. In between,
// the counts hold the addresses where records go.
kernel __attribute__((reqd_work_group_size(1, 1, 1))) void cellist_move_partition(
    CELLIST_LISTS(CELLIST_RECORD, lists),
    global const CELLIST_NODE_OF(CELLIST_RECORD) * restrict nodes,
    global const uint* restrict partitioned, uint thread_slots, uint partition_bits,
    global const uint* restrict starts) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint partition = get_global_id(0);
    const uint partitions = get_global_size(0);
    if (starts[0] > lists_view.pool_nodes) return;
    global const cellist_cursor* cursors = cellist_cursors(partitioned, thread_slots);
    global const uint* chain = (global const uint*)&cursors[(ulong)thread_slots * partitions];
    global uint* heads = (global uint*)lists_heads;
    global uint* counts = (global uint*)cellist_cell_count(lists_heads, lists_view, 0);
    const uint first = partition << partition_bits;
    const uint end = min(lists_view.cells - first, 1u << partition_bits) + first;

    for (uint cell = first; cell < end; ++cell) counts[cell] = 0;
    CELLIST_FOR_EACH_PARTITIONED(CELLIST_COUNT)
    uint at = starts[1 + partition];
    for (uint cell = first; cell < end; ++cell) {
        const uint length = counts[cell];
        heads[cell] = at;
        counts[cell] = at;
        at += length;
    }
    if (end == lists_view.cells) heads[end] = at;
    // Records go to any place of the partition. Its cache lines are fetched in order first.
    volatile global const uchar* line =
        (volatile global const uchar*)&cellist_get(lists, starts[1 + partition]);
    volatile global const uchar* end_line = (volatile global const uchar*)&cellist_get(lists, at);
    for (; line < end_line; line += CELLIST_LINE_BYTES) *line;
    CELLIST_FOR_EACH_PARTITIONED(CELLIST_MOVE)
    for (uint cell = first; cell < end; ++cell) counts[cell] -= heads[cell];
}
