// SPDX-License-Identifier: MIT
// Copies a value of each record of a range of lists into one array, in the order of the lists.
//
//   offsets   cells + 1          where each list goes, counted from the first list of all
//   values    offsets[end] - offsets[begin]   out
//
// One work-item for each cell in begin ... end - 1, or one for CELLIST_READER_CELLS of them
// (reader.cl); the range is padded to whole work-groups. The host defines CELLIST_VALUE, which
// declares a variable for a value, and CELLIST_MEMBER, which selects the value when it follows a
// record. It defines CELLIST_GATHER_GROUP, the work-items of a group, where these collect values in
// local memory to write whole lines: on GPUs.
#include <cellist/lists.clh>

// A struct, because arrays are values too, and C assigns no arrays.
typedef struct cellist_gathered {
    CELLIST_VALUE;
} cellist_gathered;

// The value of a node.
#define CELLIST_VALUE_OF(node)                                                                     \
    (*(global const cellist_gathered*)&(cellist_get(lists, node) CELLIST_MEMBER))

#ifdef CELLIST_GATHER_GROUP
// Values in local memory. One more after each 16 spreads lists over the banks.
#define CELLIST_GATHER_VALUES (16384u / (uint)sizeof(cellist_gathered))
#define CELLIST_GATHER_AT(i) ((i) + (i) / 16u)

kernel __attribute__((reqd_work_group_size(CELLIST_GATHER_GROUP, 1, 1))) void cellist_gather(
    CELLIST_LISTS(CELLIST_RECORD, lists), uint begin, uint end, global const uint* offsets,
    global cellist_gathered* values) {
    local cellist_gathered collected[CELLIST_GATHER_AT(CELLIST_GATHER_VALUES)];
    const cellist_view lists_view = cellist_view_of(lists);
    const uint item = get_local_id(0);
    const uint first_cell = begin + (uint)get_group_id(0) * CELLIST_GATHER_GROUP;
    const uint end_cell = min(first_cell + CELLIST_GATHER_GROUP, end);
    const uint cell = min(first_cell + item, end_cell);
    const bool has_cell = cell < end_cell;
    uint at = offsets[cell] - offsets[begin];
    const uint list_end = has_cell ? offsets[cell + 1] - offsets[begin] : at;
    uint node = has_cell ? cellist_begin(lists_heads, lists_view, cell) : CELLIST_NONE;
    const uint node_end = has_cell ? cellist_end(lists_heads, lists_view, cell) : CELLIST_NONE;
    const uint last = offsets[end_cell] - offsets[begin];
    for (uint first = offsets[first_cell] - offsets[begin]; first < last;) {
        const uint count = min(last - first, CELLIST_GATHER_VALUES);
        for (; at < list_end && at - first < count && node < node_end; ++at) {
            collected[CELLIST_GATHER_AT(at - first)] = CELLIST_VALUE_OF(node);
            node = cellist_next(lists_nodes, lists_typed, node);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint i = item; i < count; i += CELLIST_GATHER_GROUP)
            values[first + i] = collected[CELLIST_GATHER_AT(i)];
        barrier(CLK_LOCAL_MEM_FENCE);
        first += count;
    }
}
#elif defined(CELLIST_READER_CELLS)
kernel void cellist_gather(CELLIST_LISTS(CELLIST_RECORD, lists), uint begin, uint end,
                           global const uint* offsets, global cellist_gathered* values) {
    const uint start = offsets[begin];
    cellist_reader reader = cellist_reader_of(begin, end);
    cellist_for_each_open(reader, lists, i) {
        const uint node = reader.node[i];
        const uint at = offsets[reader.cell[i]] + reader.read[i];
        if (node < cellist_view_of(lists).pool_nodes && at < offsets[reader.cell[i] + 1]) {
            values[at - start] = CELLIST_VALUE_OF(node);
            cellist_advance(reader, lists, i);
        } else {
            cellist_close(&reader, i--);
        }
    }
}
#else
kernel void cellist_gather(CELLIST_LISTS(CELLIST_RECORD, lists), uint begin, uint end,
                           global const uint* offsets, global cellist_gathered* values) {
    const size_t item = get_global_id(0);
    if (item >= end - begin) return;
    const uint cell = begin + (uint)item;
    uint at = offsets[cell] - offsets[begin];
    const uint list_end = offsets[cell + 1] - offsets[begin];
    cellist_for_each(lists, cell, node) {
        if (at == list_end) break;
        values[at++] = CELLIST_VALUE_OF(node);
    }
}
#endif
