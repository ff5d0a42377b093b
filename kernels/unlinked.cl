// Counts the nodes that reservations hold and no link has taken.
//
//   unlinked   1   in: 0; out: such nodes
//
// One work-item a node of the pool; the range is padded to whole work-groups.
#include <cellist/lists.clh>

kernel void cellist_unlinked(CELLIST_LISTS(CELLIST_RECORD, lists), volatile global uint* unlinked) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint node = get_global_id(0);
    if (get_global_id(0) >= lists_view.capacity_nodes) return;
    if (lists_nodes[node].next == CELLIST_UNLINKED &&
        cellist_is_allocated(lists_shards, lists_view, node))
        atomic_inc(unlinked);
}
