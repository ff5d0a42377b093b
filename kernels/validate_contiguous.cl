// SPDX-License-Identifier: MIT
// Checks the offsets of lists that lie one after the other: that they ascend inside the pool, that
// they match the counts, and that every list was filled.
//
//   offsets    cells + 1   where lists with these counts begin; the heads, to skip this check
//   findings   1           in: 0; out: broken, the lists with impossible or other offsets;
//                          unfilled, the nodes that have no record; nodes, those of all lists
//
// One work-item per cell; the range is padded to whole work-groups.
#include <cellist/lists.clh>

kernel void cellist_validate_contiguous(CELLIST_LISTS(CELLIST_RECORD, lists),
                                        global const uint* offsets,
                                        volatile global cellist_findings* findings) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint begin = lists_heads[cell];
    const uint end = lists_heads[(ulong)cell + 1];
    const uint inserted = lists_heads[(ulong)lists_view.cells + 1 + cell];
    // The first list begins with the pool.
    const int is_possible =
        begin <= end && end <= lists_view.pool_nodes && (cell > 0 || begin == 0);
    if (!is_possible || begin != offsets[cell] || end != offsets[(ulong)cell + 1]) {
        atomic_inc(&findings->broken);
        atomic_max(&findings->bad_cell_from_end, CELLIST_NONE - cell);
    }
    if (!is_possible) return;
    const uint length = end - begin;
    if (length) atomic_add(&findings->nodes, length);
    // A list counts on past its end: those records were dropped.
    if (inserted < length) {
        atomic_add(&findings->unfilled, length - inserted);
        atomic_max(&findings->bad_cell_from_end, CELLIST_NONE - cell);
    }
}
