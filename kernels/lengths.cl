// The length of every list.
//
//   lengths   cells   out: nodes of the cell
//
// One work-item a cell, or one for CELLIST_READER_CELLS of them (reader.cl); the range is padded to
// whole work-groups.
#include <cellist/lists.clh>

#ifdef CELLIST_READER_CELLS
kernel void cellist_lengths(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* lengths) {
    const cellist_view lists_view = cellist_view_of(lists);
    cellist_reader reader = cellist_reader_of(0, cellist_cells(lists));
    while (cellist_refill(&reader, lists_heads)) {
        for (uint i = 0; i < reader.open; ++i) {
            const uint node = reader.node[i];
            // Links in circles end, too.
            if (node < lists_view.pool_nodes && reader.read[i] < lists_view.pool_nodes) {
                reader.node[i] = lists_nodes[node].next;
                ++reader.read[i];
            } else {
                lengths[reader.cell[i]] = reader.read[i];
                cellist_close(&reader, i--);
            }
        }
    }
}
#else
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
#endif
