// SPDX-License-Identifier: MIT
// Checks the links of every list: each allocated node is reached from exactly one head, exactly
// once.
//
//   reached   (pool_nodes + 31) / 32       in: 0; a bit a node: some link leads to it
//   findings  1                            in: 0; out: links to nodes
//                                          never allocated, links to nodes reached before, nodes
//                                          reached
//
// One work-item per cell; the range is padded to whole work-groups. A traversal ends at the first
// node that another link reached, so all traversals together take at most nodes + cells steps,
// whatever the links hold, and no address outside of the pool is read.
#include <cellist/lists.clh>

kernel void cellist_validate_linked(CELLIST_LISTS(CELLIST_RECORD, lists),
                                    volatile global uint* reached,
                                    volatile global cellist_findings* findings) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint length = 0;
    int bad = 0;
    uint node = lists_heads[cell];
    for (uint step = 0; step <= lists_view.pool_nodes && node != CELLIST_NONE; ++step) {
        if (!cellist_is_allocated(lists_shards, lists_view, node)) {
            atomic_inc(&findings->broken);
            bad = 1;
            break;
        }
        const uint bit = 1u << (node & 31u);
        if (atomic_or(&reached[node >> 5], bit) & bit) {
            atomic_inc(&findings->repeated);
            bad = 1;
            break;
        }
        ++length;
        node = lists_nodes[node].next;
    }
    if (length) atomic_add(&findings->nodes, length);
    if (bad) atomic_max(&findings->bad_cell_from_end, CELLIST_NONE - cell);
}
