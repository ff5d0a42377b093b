// Sorts every list by cellist_sort_key(record), then by the members of the record in order, by
// relinking its nodes. Any length; no memory beyond registers.
//
// Bottom-up merge sort of a linked list: pending[i] is a sorted list of 2^i nodes or none, and taking
// a node in works like adding one to a binary number, each carry merging two lists of equal size.
//
// One work-item a cell; the range is padded to whole work-groups. The host defines
// cellist_sort_key(CELLIST_RECORD), which maps the key to an unsigned integer of the same order.
#include <cellist/lists.clh>

static inline int cellist_sort_before(CELLIST_LISTS(CELLIST_RECORD, lists), uint a, uint b) {
    const ulong x = cellist_sort_key(cellist_get(lists, a));
    const ulong y = cellist_sort_key(cellist_get(lists, b));
    if (x != y) return x < y;
    return cellist_record_before(cellist_get(lists, a), cellist_get(lists, b), 0);
}

static inline uint cellist_sort_merge(CELLIST_LISTS(CELLIST_RECORD, lists), uint a, uint b) {
    uint first = CELLIST_NONE;
    uint last = CELLIST_NONE;
    for (uint step = 0; step < lists_view.capacity_nodes; ++step) {
        if (a == CELLIST_NONE || b == CELLIST_NONE) break;
        uint least = a;
        if (cellist_sort_before(CELLIST_PASS(lists), b, a)) {
            least = b;
            b = lists_nodes[b].next;
        } else {
            a = lists_nodes[a].next;
        }
        if (last == CELLIST_NONE)
            first = least;
        else
            lists_nodes[last].next = least;
        last = least;
    }
    const uint rest = a == CELLIST_NONE ? b : a;
    if (last == CELLIST_NONE) return rest;
    lists_nodes[last].next = rest;
    return first;
}

kernel void cellist_sort(CELLIST_LISTS(CELLIST_RECORD, lists)) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint head = lists_heads[cell];
    if (head == CELLIST_NONE || lists_nodes[head].next == CELLIST_NONE) return;

    uint pending[32];
    uint used = 0;
    uint node = head;
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
    for (uint level = 0; level < used; ++level)
        if (pending[level] != CELLIST_NONE)
            sorted = sorted == CELLIST_NONE
                         ? pending[level]
                         : cellist_sort_merge(CELLIST_PASS(lists), pending[level], sorted);
    lists_heads[cell] = sorted;
}
