// The length of every list.
//
//   lengths   cells   out: nodes of the cell
//
// One work-item a cell; the range is padded to whole work-groups.
#include <cellist/lists.clh>

kernel void cellist_lengths(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* lengths) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint length = 0;
    // Links in circles end, too.
    cellist_for_each(lists, cell, node) {
        if (++length == lists_view.pool_nodes) break;
    }
    lengths[cell] = length;
}
