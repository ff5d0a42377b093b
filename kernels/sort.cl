// Sorts every list by cellist_sort_key(record), then by the members of the record in order. Any
// length, in place.
//
// Linked lists are relinked; the records stay where they are. Lists of up to CELLIST_SORT_SHORT
// nodes: insertion sort of (key, node) pairs in private memory, while walking the list; then one pass
// that writes the links. Longer lists: bottom-up merge sort of the list itself. pending[i] is a sorted
// list of 2^i nodes or none, and taking a node in works like adding one to a binary number, each carry
// merging two lists of equal size.
//
// Lists in one piece: insertion sort with the keys in private memory up to CELLIST_SORT_SHORT records,
// heap sort beyond.
//
// One work-item a cell; the range is padded to whole work-groups. The host defines
// cellist_sort_key(CELLIST_RECORD), which maps the key to an unsigned integer of the same order.
#include <cellist/lists.clh>

// Longest list that is sorted in private memory.
#ifndef CELLIST_SORT_SHORT
#define CELLIST_SORT_SHORT 32
#endif

// Whether node a, with key x, comes before node b, with key y.
static inline int cellist_sort_before(CELLIST_LISTS(CELLIST_RECORD, lists), uint a, ulong x, uint b,
                                      ulong y) {
    if (x != y) return x < y;
    return cellist_record_before(cellist_get(lists, a), cellist_get(lists, b), 0);
}

// Sorts the list of a cell if it is short; returns 0 and changes nothing if it is not.
static inline int cellist_sort_short(CELLIST_LISTS(CELLIST_RECORD, lists), uint cell) {
    ulong keys[CELLIST_SORT_SHORT];
    uint nodes[CELLIST_SORT_SHORT];
    uint length = 0;
    cellist_for_each(lists, cell, node) {
        if (length == CELLIST_SORT_SHORT) return 0;
        const ulong key = cellist_sort_key(cellist_get(lists, node));
        uint at = length++;
        for (; at > 0; --at) {
            if (!cellist_sort_before(CELLIST_PASS(lists), node, key, nodes[at - 1], keys[at - 1]))
                break;
            keys[at] = keys[at - 1];
            nodes[at] = nodes[at - 1];
        }
        keys[at] = key;
        nodes[at] = node;
    }
    if (length < 2) return 1;
    lists_heads[cell] = nodes[0];
    for (uint i = 1; i < length; ++i) lists_nodes[nodes[i - 1]].next = nodes[i];
    lists_nodes[nodes[length - 1]].next = CELLIST_NONE;
    return 1;
}

static inline uint cellist_sort_merge(CELLIST_LISTS(CELLIST_RECORD, lists), uint a, uint b) {
    uint first = CELLIST_NONE;
    uint last = CELLIST_NONE;
    ulong x = cellist_sort_key(cellist_get(lists, a));
    ulong y = cellist_sort_key(cellist_get(lists, b));
    for (uint step = 0; step < lists_view.capacity_nodes; ++step) {
        const int b_first = cellist_sort_before(CELLIST_PASS(lists), b, y, a, x);
        const uint least = b_first ? b : a;
        if (last == CELLIST_NONE)
            first = least;
        else
            lists_nodes[last].next = least;
        last = least;

        const uint next = lists_nodes[least].next;
        if (next == CELLIST_NONE) break;
        if (b_first)
            b = next, y = cellist_sort_key(cellist_get(lists, b));
        else
            a = next, x = cellist_sort_key(cellist_get(lists, a));
    }
    // One list has ended with `last`; the rest of the other follows.
    lists_nodes[last].next = last == b ? a : b;
    return first;
}

static inline void cellist_sort_long(CELLIST_LISTS(CELLIST_RECORD, lists), uint cell) {
    uint pending[32];
    uint used = 0;
    uint node = lists_heads[cell];
    for (uint taken = 0; node != CELLIST_NONE && taken < lists_view.capacity_nodes; ++taken) {
        const uint next = lists_nodes[node].next;
        lists_nodes[node].next = CELLIST_NONE;
        uint level = 0;
        for (; level < used && pending[level] != CELLIST_NONE; ++level) {
            node = cellist_sort_merge(CELLIST_PASS(lists), pending[level], node);
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
                     : cellist_sort_merge(CELLIST_PASS(lists), pending[level], sorted);
    }
    lists_heads[cell] = sorted;
}

static inline int cellist_record_order(struct CELLIST_RECORD a, struct CELLIST_RECORD b) {
    const ulong x = cellist_sort_key(a);
    const ulong y = cellist_sort_key(b);
    return x != y ? x < y : cellist_record_before(a, b, 0);
}

static inline void cellist_sort_short_piece(global struct CELLIST_RECORD* records, uint length) {
    ulong keys[CELLIST_SORT_SHORT];
    for (uint i = 0; i < length; ++i) {
        const struct CELLIST_RECORD record = records[i];
        const ulong key = cellist_sort_key(record);
        uint at = i;
        for (; at > 0; --at) {
            if (keys[at - 1] < key) break;
            if (keys[at - 1] == key && !cellist_record_before(record, records[at - 1], 0)) break;
            keys[at] = keys[at - 1];
            records[at] = records[at - 1];
        }
        keys[at] = key;
        if (at != i) records[at] = record;
    }
}

// Lets `record` sink from position `at` in the heap of `length` records: the last comes first.
static inline void cellist_sift(global struct CELLIST_RECORD* records, uint at, uint length,
                                struct CELLIST_RECORD record) {
    while (at < length / 2) {
        uint child = 2 * at + 1;
        if (child + 1 < length && cellist_record_order(records[child], records[child + 1])) ++child;
        if (!cellist_record_order(record, records[child])) break;
        records[at] = records[child];
        at = child;
    }
    records[at] = record;
}

static inline void cellist_sort_long_piece(global struct CELLIST_RECORD* records, uint length) {
    for (uint i = length / 2; i > 0; --i) cellist_sift(records, i - 1, length, records[i - 1]);
    for (uint end = length - 1; end > 0; --end) {
        const struct CELLIST_RECORD last = records[end];
        records[end] = records[0];
        cellist_sift(records, 0, end, last);
    }
}

kernel void cellist_sort(CELLIST_LISTS(CELLIST_RECORD, lists)) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    if (cellist_has_mode(lists_view, CELLIST_LINKED)) {
        if (!cellist_sort_short(CELLIST_PASS(lists), cell))
            cellist_sort_long(CELLIST_PASS(lists), cell);
        return;
    }
    const uint begin = cellist_begin(lists_heads, lists_view, cell);
    const uint length = cellist_end(lists_heads, lists_view, cell) - begin;
    global struct CELLIST_RECORD* records = (global struct CELLIST_RECORD*)lists_nodes + begin;
    if (length <= CELLIST_SORT_SHORT)
        cellist_sort_short_piece(records, length);
    else
        cellist_sort_long_piece(records, length);
}
