// SPDX-License-Identifier: MIT
// Sorts lists of up to CELLIST_SORT_CHUNK_SIZE nodes; see sort.cl.
//
// Linked lists move to another pool, where each is contiguous, in any order: writing whole nodes in
// a row takes less time than writing a link here and there, and so does reading them later. The old
// pool and its heads stay as they are. Contiguous lists are sorted in place.
//
//   cells     count    the cells to sort; all, from 0 on, if `listed` is 0
//   longer    longer_end   out: cells with longer lists, as many as state->longer[stage] says
//   state     1        in and out: the nodes of the lists, how many lists are broken, and more
//   heads     cells    out: heads of the lists that move
//   nodes     pool_nodes       out: their nodes
//
// CELLIST_SORT_ITEMS work-items sort CELLIST_SORT_LISTS lists, and CELLIST_SORT_TEAM of them one
// list. Barriers stand in uniform control flow, and the range is padded to whole work-groups.

static inline uint cellist_sort_class(uint length) {
    uint index = 0;
    while (index < CELLIST_SORT_CLASSES - 1 && length > CELLIST_SORT_CLASS_MIN << index) ++index;
    return index;
}

#define CELLIST_SORT_TEAMS (CELLIST_SORT_ITEMS / CELLIST_SORT_TEAM)

CELLIST_SORT_KERNEL cellist_sort_lists(CELLIST_LISTS(CELLIST_RECORD, lists),
                                       global const uint* cells, uint listed, uint count,
                                       global uint* longer, uint longer_end, uint stage,
                                       volatile global cellist_sort_state* state,
                                       const cellist_values values
#if CELLIST_MODES == CELLIST_LINKED
                                       ,
                                       global uint* heads, global cellist_sort_node* nodes
#endif
) {
    const cellist_view lists_view = cellist_view_of(lists);
    CELLIST_SORT_SHARED cellist_sort_bits keys[CELLIST_SORT_LISTS * CELLIST_SORT_STRIDE];
    CELLIST_SORT_SHARED uchar order[CELLIST_SORT_LISTS * CELLIST_SORT_STRIDE];
    CELLIST_SORT_SHARED uint sums[CELLIST_SORT_LISTS];
    CELLIST_SORT_SHARED uint total;  // nodes of the lists
#if CELLIST_SORT_ITEMS > 1
    local uint in_class[CELLIST_SORT_CLASSES];
#endif
    global cellist_sort_node* own_nodes = (global cellist_sort_node*)lists_nodes;
    const uint item = cellist_sort_item();
    const ulong begin = (ulong)(get_global_id(0) / CELLIST_SORT_ITEMS) * CELLIST_SORT_LISTS;
    const uint own = begin < count ? min(count - (uint)begin, (uint)CELLIST_SORT_LISTS) : 0;
#define CELLIST_SORT_CELL(list) (listed ? cells[begin + (list)] : (uint)begin + (list))

    for (uint i = item; i < CELLIST_SORT_LISTS; i += CELLIST_SORT_ITEMS) sums[i] = 0;
    if (item == 0) total = 0;
#if CELLIST_SORT_ITEMS > 1
    for (uint i = item; i < CELLIST_SORT_CLASSES; i += CELLIST_SORT_ITEMS) in_class[i] = 0;
#endif

#if CELLIST_MODES == CELLIST_LINKED
    CELLIST_SORT_SHARED uint index[CELLIST_SORT_LISTS * CELLIST_SORT_STRIDE];
    CELLIST_SORT_SHARED uint next[CELLIST_SORT_LISTS];
    CELLIST_SORT_SHARED uint lengths[CELLIST_SORT_LISTS];
    CELLIST_SORT_SHARED uint firsts[CELLIST_SORT_LISTS];
    CELLIST_SORT_SHARED uint base;
    for (uint i = item; i < own; i += CELLIST_SORT_ITEMS) {
        next[i] = lists_heads[CELLIST_SORT_CELL(i)];
        lengths[i] = 0;
    }
    // One node of each list at a time: a work-item waits for all of its lists together.
    for (uint step = 0; step < CELLIST_SORT_CHUNK_SIZE; ++step) {
        uint more = 0;
        for (uint i = item; i < own; i += CELLIST_SORT_ITEMS) {
            const uint node = next[i];
            if (node >= lists_view.pool_nodes) continue;
            index[i * CELLIST_SORT_STRIDE + step] = node;
            lengths[i] = step + 1;
            next[i] = lists_nodes[node].next;
            more = 1;
        }
        if (!more) break;
    }
    cellist_sort_barrier();
    for (uint i = item; i < own; i += CELLIST_SORT_ITEMS) {
        if (next[i] < lists_view.pool_nodes) {
            cellist_sort_leave(longer, longer_end, stage, CELLIST_SORT_CELL(i), state);
            lengths[i] = CELLIST_NONE;
        } else {
            if (next[i] != CELLIST_NONE) atomic_inc(&state->broken);
            firsts[i] = cellist_sort_add(&total, lengths[i]);
        }
    }
    cellist_sort_barrier();
    if (item == 0) {
        base = atomic_add(&state->nodes, total);
        // More nodes than there are: lists share some of them.
        if (total > lists_view.pool_nodes || base > lists_view.pool_nodes - total) {
            atomic_inc(&state->broken);
            total = CELLIST_NONE;
        }
    }
#endif
    cellist_sort_barrier();

    const cellist_sort_ties known_ties = cellist_sort_known_ties(state);
    cellist_sort_ties ties = known_ties;
    for (uint round = 0; round < CELLIST_SORT_LISTS / CELLIST_SORT_TEAMS; ++round) {
        const uint list = item / CELLIST_SORT_TEAM + round * CELLIST_SORT_TEAMS;
        const uint member = item % CELLIST_SORT_TEAM;
        const uint row = list * CELLIST_SORT_STRIDE;
        const int expects_ties = cellist_sort_expects_ties(&ties);
        uint length = 0;
#if CELLIST_MODES == CELLIST_LINKED
        if (list < own && lengths[list] != CELLIST_NONE && total != CELLIST_NONE) {
            length = lengths[list];
            if (member == 0)
                heads[CELLIST_SORT_CELL(list)] = length > 0 ? base + firsts[list] : CELLIST_NONE;
        }
#define CELLIST_SORT_OWN own_nodes, CELLIST_NONE, index + row
#define CELLIST_SORT_OWN_NODE(i) index[row + (i)]
#else
        uint first = 0;
        if (list < own) {
            const uint cell = CELLIST_SORT_CELL(list);
            first = cellist_begin(lists_heads, lists_view, cell);
            length = cellist_sort_length(lists_heads, lists_view, cell);
            const int is_broken = cellist_sort_is_broken(lists_heads, lists_view, cell);
            if (length > CELLIST_SORT_CHUNK_SIZE) {
                length = 0;
                if (member == 0) cellist_sort_leave(longer, longer_end, stage, cell, state);
            }
            if (member == 0 && is_broken) atomic_inc(&state->broken);
            if (member == 0 && length > 0) cellist_sort_add(&total, length);
        }
#define CELLIST_SORT_OWN own_nodes, first, 0
#define CELLIST_SORT_OWN_NODE(i) first + (i)
#endif
        for (uint i = member; i < length; i += CELLIST_SORT_TEAM) {
            global const CELLIST_RECORD_TYPE* record =
                &cellist_sort_record(own_nodes[CELLIST_SORT_OWN_NODE(i)]);
            const cellist_sort_bits key = cellist_sort_key(record, values);
            keys[row + i] = expects_ties ? cellist_sort_add_word(key, record) : key;
        }
        cellist_sort_barrier();
        uint ranks[CELLIST_SORT_RUNS * CELLIST_SORT_WIDTH];
        if (length > 0 && !expects_ties)
            cellist_sort_add(&sums[list], cellist_sort_rank(keys + row, length, member, ranks));
#if CELLIST_SORT_ITEMS > 1
        if (member == 0 && length > 0) atomic_inc(&in_class[cellist_sort_class(length)]);
#endif
        cellist_sort_barrier();
        const int unique = !expects_ties && cellist_sort_unique(sums[list], length);
        if (!expects_ties) cellist_sort_note_ties(&ties, length, unique);
        if (unique) {
            cellist_sort_order(ranks, length, member, order + row);
        } else {
            if (!expects_ties) cellist_sort_add_first_word(CELLIST_SORT_OWN, keys + row, length);
            cellist_sort_order_equal(CELLIST_SORT_OWN, keys + row, length, member, &ties, ranks,
                                     order + row);
        }
        cellist_sort_barrier();
#if CELLIST_MODES == CELLIST_LINKED
        for (uint i = member; i < length; i += CELLIST_SORT_TEAM) {
            const uint at = base + firsts[list];
            cellist_sort_store(nodes, at + i, at + length - 1,
                               &own_nodes[index[row + order[row + i]]]);
        }
#else
        cellist_sort_permute(own_nodes, first, 0, length, member, order + row);
#endif
    }

    cellist_sort_tell_ties(state, &known_ties, &ties);
#if CELLIST_MODES != CELLIST_LINKED
    cellist_sort_barrier();
    if (item == 0 && total > 0) cellist_sort_count_nodes(state, total);
#endif
#if CELLIST_SORT_ITEMS > 1
    for (uint i = item; i < CELLIST_SORT_CLASSES; i += CELLIST_SORT_ITEMS)
        if (in_class[i] > 0) atomic_add(&state->in_class[i], in_class[i]);
#endif
}

#if CELLIST_MODES == CELLIST_LINKED
// Says that the first `stored` nodes of the pool are allocated, and no others; one work-item a
// shard, and one a thread slot.
kernel void cellist_sort_allocate(CELLIST_LISTS(CELLIST_RECORD, lists), uint stored) {
    const cellist_view lists_view = cellist_view_of(lists);
    cellist_allocate_first(lists_shards, lists_view, stored, get_global_id(0));
}
#endif
