// SPDX-License-Identifier: MIT
// Divides contiguous lists by a predicate. The records that stay move to the start of their list,
// in order; the removed records follow in any order.
//
//   lengths   cells   out: the records that stay
//
// One work-item per cell; the range is padded to whole work-groups. The host defines cellist_values
// and cellist_sort_key; the key of a record is odd if the record is to go.
#include <cellist/lists.clh>

kernel void cellist_remove(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* lengths,
                           const cellist_values values) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint first = cellist_begin(lists_heads, cellist_view_of(lists), cell);
    uint end = first;
    cellist_for_each(lists, cell, node) {
        if (cellist_sort_key(&cellist_get(lists, node), values) & 1u) continue;
        if (end != node) {
            const CELLIST_RECORD_TYPE stays = cellist_get(lists, node);
            cellist_get(lists, node) = cellist_get(lists, end);
            cellist_get(lists, end) = stays;
        }
        ++end;
    }
    lengths[cell] = end - first;
}
