// SPDX-License-Identifier: MIT
// Brings the top k records of every list, those that come first, to its first nodes, in order; the
// others follow in any order. See sort.cl. The whole list is visited.
//
//   top_k       records that go to the first nodes of each list, at most CELLIST_SORT_TOP_K
//   length_max  lists of more nodes are left as they are, and counted in state->longer[0]
//   state       also counts the nodes, and the lists that end outside of the pool
//
// Links and offsets stay as they are, records move: the top records to the first nodes of the list,
// and those that were there to where the top records come from. A work-item has CELLIST_SORT_LISTS
// lists.

// The nodes of a list whose records come first, in order, and its first nodes.
typedef struct cellist_sort_top {
    cellist_sort_bits keys[CELLIST_SORT_TOP_K];
    uint nodes[CELLIST_SORT_TOP_K];
    uint numbers[CELLIST_SORT_TOP_K];  // in the list, from 0
    uint targets[CELLIST_SORT_TOP_K];  // the first nodes
} cellist_sort_top;

// Looks at the next node of a list, the `number`-th.
static inline void cellist_sort_take(CELLIST_LISTS(CELLIST_RECORD, lists), cellist_sort_top* top,
                                     uint top_k, uint number, uint node,
                                     const cellist_values values) {
    const cellist_sort_bits key = cellist_sort_key(&cellist_get(lists, node), values);
    if (number < top_k) top->targets[number] = node;
    uint at = min(number, top_k);
    for (; at > 0; --at) {
        if (key > top->keys[at - 1]) break;
        if (key == top->keys[at - 1] &&
            !cellist_record_before(&cellist_get(lists, node),
                                   &cellist_get(lists, top->nodes[at - 1]), 0))
            break;
        if (at == top_k) continue;
        top->keys[at] = top->keys[at - 1];
        top->nodes[at] = top->nodes[at - 1];
        top->numbers[at] = top->numbers[at - 1];
    }
    if (at == top_k) return;
    top->keys[at] = key;
    top->nodes[at] = node;
    top->numbers[at] = number;
}

// Moves `count` records to the first nodes.
static inline void cellist_sort_move(CELLIST_LISTS(CELLIST_RECORD, lists),
                                     const cellist_sort_top* top, uint count) {
    CELLIST_RECORD_TYPE records[CELLIST_SORT_TOP_K];
    // Bit i: the i-th node of the list keeps one of the first `count` records.
    ulong staying = 0;
    for (uint i = 0; i < count; ++i) {
        records[i] = cellist_get(lists, top->nodes[i]);
        if (top->numbers[i] < count) staying |= 1ul << top->numbers[i];
    }
    uint leaving = 0;
    for (uint i = 0; i < count; ++i) {
        if (top->numbers[i] < count) continue;
        while (staying >> leaving & 1) ++leaving;
        cellist_get(lists, top->nodes[i]) = cellist_get(lists, top->targets[leaving++]);
    }
    for (uint i = 0; i < count; ++i) cellist_get(lists, top->targets[i]) = records[i];
}

kernel void cellist_sort_partial(CELLIST_LISTS(CELLIST_RECORD, lists), uint top_k, uint length_max,
                                 volatile global cellist_sort_state* state,
                                 const cellist_values values) {
    const cellist_view lists_view = cellist_view_of(lists);
    const ulong begin = (ulong)get_global_id(0) * CELLIST_SORT_LISTS;
    if (begin >= cellist_cells(lists)) return;
    const uint own = min(cellist_cells(lists) - (uint)begin, (uint)CELLIST_SORT_LISTS);
    cellist_sort_top tops[CELLIST_SORT_LISTS];
    uint next[CELLIST_SORT_LISTS];
    uint ends[CELLIST_SORT_LISTS];  // a node that is not of the list
    uint lengths[CELLIST_SORT_LISTS];
    for (uint i = 0; i < own; ++i) {
        const uint cell = (uint)begin + i;
        lengths[i] = 0;
#if CELLIST_MODES == CELLIST_LINKED
        next[i] = lists_heads[cell];
        ends[i] = CELLIST_NONE;
#else
        next[i] = cellist_begin(lists_heads, lists_view, cell);
        ends[i] = next[i] + cellist_sort_length(lists_heads, lists_view, cell);
#endif
    }
    // One node of each list at a time: a work-item waits for all of its lists together.
    for (uint step = 0; step < length_max; ++step) {
        uint more = 0;
        for (uint i = 0; i < own; ++i) {
            const uint node = next[i];
            if (node == ends[i] || node >= lists_view.pool_nodes) continue;
#if CELLIST_MODES == CELLIST_LINKED
            next[i] = lists_nodes[node].next;
#else
            ++next[i];
#endif
            cellist_sort_take(CELLIST_PASS(lists), &tops[i], top_k, step, node, values);
            lengths[i] = step + 1;
            more = 1;
        }
        if (!more) break;
    }
    uint nodes = 0;
    for (uint i = 0; i < own; ++i) nodes += lengths[i];
    if (nodes > 0) cellist_sort_count_nodes(state, nodes);
    for (uint i = 0; i < own; ++i) {
        if (next[i] != ends[i])
            atomic_inc(next[i] < lists_view.pool_nodes ? &state->longer[0] : &state->broken);
        else
            cellist_sort_move(CELLIST_PASS(lists), &tops[i], min(lengths[i], top_k));
    }
}
