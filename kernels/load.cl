// SPDX-License-Identifier: MIT
// Replaces all linked lists or slots by the lists of a contiguous copy, in their order.
//
//   from      the copy; a list begins where the copy says
//   offsets   cells + 1   where each list goes if lists are contiguous; these say how long it is
//
// At least one work-item per cell and per counter; the range is padded to whole work-groups. The
// counters are 0 before.
#include <cellist/lists.clh>

kernel void cellist_load(CELLIST_LISTS(CELLIST_RECORD, lists), CELLIST_LISTS(CELLIST_RECORD, from),
                         global const uint* offsets) {
    const cellist_view lists_view = cellist_view_of(lists);
    const int linked = cellist_has_mode(lists_view, CELLIST_LINKED);
    const uint cell = get_global_id(0);
    if (linked)
        cellist_allocate_first(lists_shards, lists_view, offsets[cellist_cells(lists)], cell);
    if (cell >= cellist_cells(lists)) return;
    const uint first = offsets[cell];
    const uint end = offsets[cell + 1];
    uint source = cellist_begin(from_heads, cellist_view_of(from), cell);
    if (linked) {
        lists_heads[cell] = first < end ? first : CELLIST_NONE;
        for (uint node = first; node < end; ++node) {
            cellist_get(lists, node) = cellist_get(from, source++);
            lists_nodes[node].next = node + 1 < end ? node + 1 : CELLIST_NONE;
        }
        return;
    }
    lists_heads[cell] = end - first;
    uint node = cellist_fixed_begin(lists_heads, lists_view, cell);
    for (uint i = first; i < end; ++i) cellist_get(lists, node++) = cellist_get(from, source++);
}
