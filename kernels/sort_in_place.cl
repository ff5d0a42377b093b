// SPDX-License-Identifier: MIT
// Sorts lists of any length where there is no memory for a second pool, one work-item per list. See
// sort.cl.
//
// Linked lists: bottom-up merge sort of the list itself. pending[i] is a sorted list of 2^i nodes
// or none, and taking a node in works like adding one to a binary number, each carry merging two
// lists of equal size. Every loop ends whatever the links are. Contiguous lists: heap sort.
//
//   cells   count   the cells to sort; all, from 0 on, if `listed` is 0

#if CELLIST_MODES == CELLIST_LINKED

// Merges two sorted lists of up to `most` nodes together.
static inline uint cellist_sort_merge_lists(CELLIST_LISTS(CELLIST_RECORD, lists), uint a, uint b,
                                            ulong most, const cellist_values values) {
    const cellist_view lists_view = cellist_view_of(lists);
    uint first = CELLIST_NONE;
    uint last = CELLIST_NONE;
    cellist_sort_bits x = cellist_sort_key(&cellist_get(lists, a), values);
    cellist_sort_bits y = cellist_sort_key(&cellist_get(lists, b), values);
    for (ulong step = 0; step < most; ++step) {
        const int b_first =
            cellist_sort_before(&cellist_get(lists, b), y, &cellist_get(lists, a), x);
        const uint least = b_first ? b : a;
        if (last == CELLIST_NONE)
            first = least;
        else
            lists_nodes[last].next = least;
        last = least;

        const uint next = lists_nodes[least].next;
        if (next >= lists_view.pool_nodes) break;
        if (b_first)
            b = next, y = cellist_sort_key(&cellist_get(lists, b), values);
        else
            a = next, x = cellist_sort_key(&cellist_get(lists, a), values);
    }
    // One list has ended with `last`; the rest of the other follows.
    lists_nodes[last].next = last == b ? a : b;
    return first;
}

static inline void cellist_sort_cell(CELLIST_LISTS(CELLIST_RECORD, lists), uint cell,
                                     const cellist_values values) {
    const cellist_view lists_view = cellist_view_of(lists);
    uint pending[32];
    uint used = 0;
    uint node = lists_heads[cell];
    for (uint taken = 0; node < lists_view.pool_nodes && taken < lists_view.pool_nodes; ++taken) {
        const uint next = lists_nodes[node].next;
        lists_nodes[node].next = CELLIST_NONE;
        uint level = 0;
        for (; level < used && pending[level] != CELLIST_NONE; ++level) {
            node = cellist_sort_merge_lists(CELLIST_PASS(lists), pending[level], node, 2ul << level,
                                            values);
            pending[level] = CELLIST_NONE;
        }
        if (level == used) ++used;
        pending[level] = node;
        node = next;
    }

    uint sorted = CELLIST_NONE;
    for (uint level = 0; level < used; ++level) {
        if (pending[level] == CELLIST_NONE) continue;
        sorted = sorted == CELLIST_NONE
                     ? pending[level]
                     : cellist_sort_merge_lists(CELLIST_PASS(lists), pending[level], sorted,
                                                2ul << level, values);
    }
    lists_heads[cell] = sorted;
}

#else

static inline int cellist_sort_is_first(global const CELLIST_RECORD_TYPE* a,
                                        global const CELLIST_RECORD_TYPE* b,
                                        const cellist_values values) {
    return cellist_sort_before(a, cellist_sort_key(a, values), b, cellist_sort_key(b, values));
}

static inline void cellist_sort_swap(global CELLIST_RECORD_TYPE* a, global CELLIST_RECORD_TYPE* b) {
    global cellist_sort_piece* x = (global cellist_sort_piece*)a;
    global cellist_sort_piece* y = (global cellist_sort_piece*)b;
    for (uint i = 0; i < CELLIST_SORT_PIECES; ++i) {
        const cellist_sort_piece moved = x[i];
        x[i] = y[i];
        y[i] = moved;
    }
}

// Lets the record at `at` sink in the heap of `length` records: the last comes first.
static inline void cellist_sort_sift(global CELLIST_RECORD_TYPE* records, uint at, uint length,
                                     const cellist_values values) {
    while (at < length / 2) {
        uint child = 2 * at + 1;
        if (child + 1 < length &&
            cellist_sort_is_first(&records[child], &records[child + 1], values))
            ++child;
        if (!cellist_sort_is_first(&records[at], &records[child], values)) break;
        cellist_sort_swap(&records[at], &records[child]);
        at = child;
    }
}

static inline void cellist_sort_cell(CELLIST_LISTS(CELLIST_RECORD, lists), uint cell,
                                     const cellist_values values) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint length = cellist_sort_length(lists_heads, lists_view, cell);
    if (length < 2) return;
    global CELLIST_RECORD_TYPE* records =
        &cellist_get(lists, cellist_begin(lists_heads, lists_view, cell));
    for (uint i = length / 2; i > 0; --i) cellist_sort_sift(records, i - 1, length, values);
    for (uint end = length - 1; end > 0; --end) {
        cellist_sort_swap(&records[0], &records[end]);
        cellist_sort_sift(records, 0, end, values);
    }
}

#endif

kernel void cellist_sort_in_place(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* cells,
                                  uint listed, uint count, const cellist_values values) {
    const uint i = get_global_id(0);
    if (i < count) cellist_sort_cell(CELLIST_PASS(lists), listed ? cells[i] : i, values);
}
