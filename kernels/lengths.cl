// SPDX-License-Identifier: MIT
// The length of every list.
//
//   lengths   cells   out: nodes of the cell
//
// One work-item per cell, or one for CELLIST_READER_CELLS of them (reader.cl); the range is padded
// to whole work-groups.
#include <cellist/lists.clh>

#ifdef CELLIST_READER_CELLS
kernel void cellist_lengths(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* lengths) {
    const cellist_view lists_view = cellist_view_of(lists);
    cellist_reader reader = cellist_reader_of(0, cellist_cells(lists));
    cellist_for_each_open(reader, lists, i) {
        // Links in circles end, too.
        if (reader.node[i] < lists_view.pool_nodes && reader.read[i] < lists_view.pool_nodes) {
            cellist_advance(reader, lists, i);
        } else {
            lengths[reader.cell[i]] = reader.read[i];
            cellist_close(&reader, i--);
        }
    }
}
#else
kernel void cellist_lengths(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* lengths) {
    const uint cell = get_global_id(0);
    if (cell < cellist_cells(lists)) lengths[cell] = cellist_length(lists, cell);
}
#endif

// The number of cells by the length of their list.
//
//   lengths     cells
//   histogram   bins    in: 0; out: the cells of each length, those with longer lists in the last
//
// One work-item per cell; the range is padded to whole work-groups. A work-group counts the first
// CELLIST_LOCAL_BINS bins in local memory.
#define CELLIST_LOCAL_BINS 256u

kernel void cellist_length_histogram(global const uint* lengths, uint cells, uint bins,
                                     volatile global uint* histogram) {
    local uint counts[CELLIST_LOCAL_BINS];
    const uint items = get_local_size(0);
    const uint cell = get_global_id(0);
    for (uint i = get_local_id(0); i < CELLIST_LOCAL_BINS; i += items) counts[i] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (cell < cells) {
        const uint bin = min(lengths[cell], bins - 1u);
        if (bin < CELLIST_LOCAL_BINS)
            atomic_inc(&counts[bin]);
        else
            atomic_inc(&histogram[bin]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < min(bins, CELLIST_LOCAL_BINS); i += items)
        if (counts[i] != 0) atomic_add(&histogram[i], counts[i]);
}
