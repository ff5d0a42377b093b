// Sorts lists of up to CELLIST_SORT_SLOTS nodes; see sort.cl. Linked lists are relinked, their records
// stay where they are; records of lists in one piece move.
//
//   cells    the cells to sort if `listed` is not 0, else all from 0 on
//   count    how many
//   longer   cells whose lists are longer, as many as state->longer says, `capacity` at most
//
// CELLIST_SORT_ITEMS work-items sort CELLIST_SORT_LISTS lists, and a team of CELLIST_SORT_TEAM of them
// one list at a time. Barriers stand in uniform control flow.

// Records of a list for each of its work-items.
#define CELLIST_SORT_SHARE (CELLIST_SORT_SLOTS / CELLIST_SORT_TEAM)
#define CELLIST_SORT_TEAMS (CELLIST_SORT_ITEMS / CELLIST_SORT_TEAM)

CELLIST_SORT_KERNEL cellist_sort_lists(CELLIST_LISTS(CELLIST_RECORD, lists),
                                       global const uint* cells, uint listed, uint count,
                                       global uint* longer, volatile global cellist_sort_state* state,
                                       uint capacity) {
    CELLIST_SORT_SHARED cellist_sort_bits keys[CELLIST_SORT_LISTS * CELLIST_SORT_STRIDE];
    CELLIST_SORT_SHARED uchar order[CELLIST_SORT_LISTS * CELLIST_SORT_STRIDE];
    CELLIST_SORT_SHARED uint lengths[CELLIST_SORT_LISTS];
    CELLIST_SORT_SHARED uint firsts[CELLIST_SORT_LISTS];
    CELLIST_SORT_SHARED uint places[CELLIST_SORT_LISTS];  // sums of what ranking found
#if CELLIST_MODES == CELLIST_LINKED
    CELLIST_SORT_SHARED uint nodes[CELLIST_SORT_LISTS * CELLIST_SORT_STRIDE];
#else
    CELLIST_SORT_SHARED uint* nodes = 0;
    CELLIST_RECORD records[CELLIST_SORT_SHARE];
#endif
    const uint item = cellist_sort_item();
    const ulong begin = (ulong)(get_global_id(0) / CELLIST_SORT_ITEMS) * CELLIST_SORT_LISTS;
    const uint own = begin < count ? min(count - (uint)begin, (uint)CELLIST_SORT_LISTS) : 0;

    // The lengths and the first nodes of the lists.
    for (uint i = item; i < own; i += CELLIST_SORT_ITEMS) {
        const uint cell = listed ? cells[begin + i] : (uint)begin + i;
#if CELLIST_MODES == CELLIST_LINKED
        firsts[i] = lists_heads[cell];
        lengths[i] = 0;
#else
        firsts[i] = cellist_begin(lists_heads, lists_view, cell);
        lengths[i] = cellist_sort_length(lists_heads, lists_view, cell);
#endif
    }
#if CELLIST_MODES == CELLIST_LINKED
    // A node of each list at a time: their memory is read at the same time.
    for (uint step = 0; step < CELLIST_SORT_SLOTS; ++step) {
        uint more = 0;
        for (uint i = item; i < own; i += CELLIST_SORT_ITEMS) {
            const uint node = firsts[i];
            if (node >= lists_view.capacity_nodes) continue;
            more = 1;
            nodes[i * CELLIST_SORT_STRIDE + step] = node;
            lengths[i] = step + 1;
            firsts[i] = lists_nodes[node].next;
        }
        if (!more) break;
    }
#endif
    for (uint i = item; i < own; i += CELLIST_SORT_ITEMS) {
        places[i] = 0;
#if CELLIST_MODES == CELLIST_LINKED
        if (firsts[i] >= lists_view.capacity_nodes) continue;
#else
        if (lengths[i] <= CELLIST_SORT_SLOTS) continue;
#endif
        lengths[i] = 0;
        const uint at = atomic_inc(&state->longer);
        if (at < capacity) longer[at] = listed ? cells[begin + i] : (uint)begin + i;
    }
    cellist_sort_barrier();

    for (uint round = 0; round < CELLIST_SORT_LISTS / CELLIST_SORT_TEAMS; ++round) {
        const uint list = item / CELLIST_SORT_TEAM + round * CELLIST_SORT_TEAMS;
        const uint member = item % CELLIST_SORT_TEAM;
        const uint length = list < own ? lengths[list] : 0;
        const uint first = firsts[list];
        const uint row = list * CELLIST_SORT_STRIDE;
        for (uint i = member; i < length; i += CELLIST_SORT_TEAM)
            keys[row + i] = cellist_sort_key(
                cellist_get(lists, cellist_sort_node(nodes + row, first, i)));
        cellist_sort_barrier();
        for (uint at = member * CELLIST_SORT_WIDTH; at < length;
             at += CELLIST_SORT_TEAM * CELLIST_SORT_WIDTH)
            cellist_sort_add(&places[list],
                             cellist_sort_rank(keys + row, length, at, order + row));
        cellist_sort_barrier();
        if (length > 0 && places[list] != length * (length - 1) / 2)
            for (uint at = member * CELLIST_SORT_WIDTH; at < length;
                 at += CELLIST_SORT_TEAM * CELLIST_SORT_WIDTH)
                cellist_sort_rank_equal(CELLIST_PASS(lists), keys + row, nodes + row, first, length,
                                        at, order + row);
        cellist_sort_barrier();
#if CELLIST_MODES == CELLIST_LINKED
        for (uint i = member; i < length; i += CELLIST_SORT_TEAM) {
            const uint node = nodes[row + order[row + i]];
            if (i == 0) lists_heads[listed ? cells[begin + list] : (uint)begin + list] = node;
            lists_nodes[node].next =
                i + 1 < length ? nodes[row + order[row + i + 1]] : CELLIST_NONE;
        }
#else
        for (uint i = 0; i < CELLIST_SORT_SHARE && member + i * CELLIST_SORT_TEAM < length; ++i)
            records[i] = cellist_get(lists, first + order[row + member + i * CELLIST_SORT_TEAM]);
        cellist_sort_barrier();
        for (uint i = 0; i < CELLIST_SORT_SHARE && member + i * CELLIST_SORT_TEAM < length; ++i)
            cellist_get(lists, first + member + i * CELLIST_SORT_TEAM) = records[i];
#endif
    }
}
