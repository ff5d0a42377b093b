// SPDX-License-Identifier: MIT
// The neighbours of every record, as rows of indices. The same kernel runs twice: a pass counts the
// neighbours, then scan.cl computes where the rows begin, and another pass stores them.
//
//   lists      contiguous. The place of a record is its node
//   stores     0 in the pass that counts
//   counts     records       neighbours of each record: 0 before the pass that counts, the length
//                            of its row before the other, which counts down to 0 again
//   offsets    records + 1   where the rows begin; read by the pass that stores
//   indices    pairs         out of the pass that stores
//   cells      records       the cell of each record; only where each record has a work-item
//
// The host defines CELLIST_RECORD, cellist_values, cellist_distance(record, other, values), and
// CELLIST_INDEX(node), the index of a record.
//
// On processors it also defines CELLIST_CANDIDATES: one work-item per cell copies that many records
// from the cells around it to private memory. All records of the cell are compared with these
// candidates, in loops without branches, which compilers vectorise. Elsewhere each record has a
// work-item.
//
// The expression may have another value in the second pass. Rows then have undefined indices, but
// no work-item stores beyond a row.
#include <cellist/lists.clh>

#ifdef CELLIST_CANDIDATES

typedef struct cellist_candidates {
    CELLIST_RECORD_TYPE records[CELLIST_CANDIDATES];
    uint nodes[CELLIST_CANDIDATES];
    uint count;
} cellist_candidates;

// Compares the records begin ... end - 1 with the candidates.
static void cellist_compare(CELLIST_LISTS(CELLIST_RECORD, lists),
                            const cellist_candidates* candidates, uint begin, uint end,
                            float radius, const cellist_values values, uint stores,
                            global uint* counts, global const uint* offsets, global uint* indices) {
    uint is_neighbour[CELLIST_CANDIDATES];
    uint found[CELLIST_CANDIDATES];
    for (uint i = begin; i < end; ++i) {
        const CELLIST_RECORD_TYPE record = cellist_get(lists, i);
        uint length = 0;
        for (uint j = 0; j < candidates->count; ++j) {
            is_neighbour[j] =
                (cellist_distance(&record, &candidates->records[j], values) <= radius) &
                (candidates->nodes[j] != i);
            length += is_neighbour[j];
        }
        if (!stores) {
            counts[i] += length;
            continue;
        }
        // No branch: it would be mispredicted for many candidates.
        length = 0;
        for (uint j = 0; j < candidates->count; ++j) {
            found[length] = candidates->nodes[j];
            length += is_neighbour[j];
        }
        const uint missing = counts[i];
        length = min(length, missing);
        global uint* row = indices + (offsets[i + 1] - missing);
        for (uint j = 0; j < length; ++j) row[j] = CELLIST_INDEX(found[j]);
        counts[i] = missing - length;
    }
}

// One work-item per cell.
kernel void cellist_neighbours(CELLIST_LISTS(CELLIST_RECORD, lists), uint radius_cells,
                               float radius, const cellist_values values, uint stores,
                               global uint* counts, global const uint* offsets,
                               global uint* indices) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint begin = cellist_begin(lists_heads, cellist_view_of(lists), cell);
    const uint end = cellist_end(lists_heads, cellist_view_of(lists), cell);
    if (begin >= end) return;
    cellist_candidates candidates;
    candidates.count = 0;
    cellist_for_each_around(lists, cell, radius_cells, node) {
        if (candidates.count == CELLIST_CANDIDATES) {
            cellist_compare(CELLIST_PASS(lists), &candidates, begin, end, radius, values, stores,
                            counts, offsets, indices);
            candidates.count = 0;
        }
        candidates.records[candidates.count] = cellist_get(lists, node);
        candidates.nodes[candidates.count++] = node;
    }
    cellist_compare(CELLIST_PASS(lists), &candidates, begin, end, radius, values, stores, counts,
                    offsets, indices);
}

#else

// The cell of each record; one work-item per cell.
kernel void cellist_cells_of_records(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* cells) {
    const uint cell = get_global_id(0);
    cellist_for_each(lists, cell, node) cells[node] = cell;
}

// One work-item per record.
kernel void cellist_neighbours(CELLIST_LISTS(CELLIST_RECORD, lists), uint radius_cells,
                               float radius, const cellist_values values, uint stores,
                               global uint* counts, global const uint* offsets,
                               global uint* indices, uint records, global const uint* cells) {
    const uint i = get_global_id(0);
    if (i >= records) return;
    const CELLIST_RECORD_TYPE record = cellist_get(lists, i);
    const uint begin = stores ? offsets[i] : 0;
    const uint end = stores ? offsets[i + 1] : CELLIST_NONE;
    uint at = begin;
    cellist_for_each_around(lists, cells[i], radius_cells, node) {
        const CELLIST_RECORD_TYPE other = cellist_get(lists, node);
        if (node == i || !(cellist_distance(&record, &other, values) <= radius)) continue;
        if (at == end) break;
        if (stores) indices[at] = CELLIST_INDEX(node);
        ++at;
    }
    counts[i] = stores ? 0 : at - begin;
}

#endif
