// SPDX-License-Identifier: MIT
// Sorts long lists with all work-items together: chunks of CELLIST_SORT_CHUNK_SIZE nodes are
// ranked, then merged in passes between two pools. See sort.cl.
//
// Linked lists are copied to another pool first, each contiguous there. They are traversed in
// parallel: some nodes are splitters, one in each 2^CELLIST_SORT_SEGMENT_BITS nodes of the pool, at
// a place that depends on a hash. A list consists of segments, each from the head or a splitter to
// the next splitter (Helman, JaJa: "Designing Practical Efficient Algorithms for Symmetric
// Multiprocessors", ALENEX 1999, section 4).
//
//   longer        lists                the cells
//   segments      splitters + lists    a segment's nodes, and the next segment or CELLIST_NONE; the
//                                      last ones begin at the heads
//   offsets       splitters + lists    the list of a segment or CELLIST_NONE, and its nodes before
//                                      the segment
//   long_lists    lists                where each list is
//   chunk_owners  chunks_max           the list of each chunk
//   heads         cells                heads of the lists that move
//   nodes         pool_nodes           their nodes
//   from, to      pool_nodes           the pools; every second pass goes from the pool that holds
//                                      the lists to the other
//   keys          pool_nodes           if CELLIST_SORT_KEEPS_KEYS is not 0: the key of each node of
//                                      the lists, with the first word where there is room.
//                                      keys_from and keys_to go with the pools. Work-items that
//                                      merge parts of a list must agree on where the parts end, so
//                                      each key is computed once
//
// A contiguous list stays a list between any two of these kernels. Every loop is bounded, and no
// link leads outside of the pool, whatever the links are.

// Stands for the next segment where one is too long: a segment of a sound list is so long once in
// e^64 times.
#define CELLIST_SORT_BROKEN (CELLIST_NONE - 1u)
#define CELLIST_SORT_SEGMENT_MAX (64u << CELLIST_SORT_SEGMENT_BITS)

#if CELLIST_MODES == CELLIST_LINKED

static inline uint cellist_sort_splitters(const cellist_view view) {
    return view.pool_nodes >> CELLIST_SORT_SEGMENT_BITS;
}

static inline uint cellist_sort_splitter(uint segment) {
    const uint hash = segment * 0x9E3779B1u >> (32u - CELLIST_SORT_SEGMENT_BITS);
    return (segment << CELLIST_SORT_SEGMENT_BITS) + hash;
}

static inline int cellist_sort_is_splitter(const cellist_view view, uint node) {
    const uint segment = node >> CELLIST_SORT_SEGMENT_BITS;
    return segment < cellist_sort_splitters(view) && node == cellist_sort_splitter(segment);
}

static inline uint cellist_sort_segment_begin(CELLIST_LISTS(CELLIST_RECORD, lists),
                                              global const uint* longer, uint segment) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint splitters = cellist_sort_splitters(lists_view);
    return segment < splitters ? cellist_sort_splitter(segment)
                               : lists_heads[longer[segment - splitters]];
}

// How long each segment is. A work-item traverses CELLIST_SORT_LISTS segments at a time.
kernel void cellist_sort_measure(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* longer,
                                 uint count, global uint2* segments) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint splitters = cellist_sort_splitters(lists_view);
    const ulong end = (ulong)splitters + count;
    const ulong begin = (ulong)get_global_id(0) * CELLIST_SORT_LISTS;
    if (begin >= end) return;
    const uint own = (uint)min(end - begin, (ulong)CELLIST_SORT_LISTS);
    uint next[CELLIST_SORT_LISTS];
    uint lengths[CELLIST_SORT_LISTS];
    for (uint i = 0; i < own; ++i) {
        const uint segment = (uint)begin + i;
        next[i] = cellist_sort_segment_begin(CELLIST_PASS(lists), longer, segment);
        lengths[i] = segment < splitters;
        if (segment < splitters) next[i] = lists_nodes[next[i]].next;
    }
    for (uint step = 0; step < CELLIST_SORT_SEGMENT_MAX; ++step) {
        uint more = 0;
        for (uint i = 0; i < own; ++i) {
            const uint node = next[i];
            if (node >= lists_view.pool_nodes || cellist_sort_is_splitter(lists_view, node))
                continue;
            next[i] = lists_nodes[node].next;
            ++lengths[i];
            more = 1;
        }
        if (!more) break;
    }
    for (uint i = 0; i < own; ++i) {
        uint after = CELLIST_NONE;
        if (next[i] < lists_view.pool_nodes)
            after = cellist_sort_is_splitter(lists_view, next[i])
                        ? next[i] >> CELLIST_SORT_SEGMENT_BITS
                        : CELLIST_SORT_BROKEN;
        else if (next[i] != CELLIST_NONE)
            after = CELLIST_SORT_BROKEN;
        segments[begin + i] = (uint2)(lengths[i], after);
    }
}

// Finds the offset of each segment of a list. Returns the length of the list, or 0 if it is broken.
static inline uint cellist_sort_chain(const cellist_view view, uint list,
                                      global const uint2* segments, global uint2* offsets) {
    const uint splitters = cellist_sort_splitters(view);
    uint segment = splitters + list;
    uint length = 0;
    for (uint step = 0; step <= splitters; ++step) {
        const uint2 own = segments[segment];
        offsets[segment] = (uint2)(list, length);
        length += own.x;
        if (length > view.pool_nodes || own.y == CELLIST_SORT_BROKEN) return 0;
        if (own.y == CELLIST_NONE) return length;
        segment = own.y;
    }
    return 0;
}

#endif

// Gives each list its chunks, and linked lists their nodes; one work-item per list.
kernel void cellist_sort_assign(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* longer,
                                uint count, global cellist_sort_long_list* long_lists,
                                global uint* chunk_owners, uint chunks_max,
                                volatile global cellist_sort_state* state
#if CELLIST_MODES == CELLIST_LINKED
                                ,
                                global const uint2* segments, global uint2* offsets,
                                global uint* heads
#endif
) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_sort_long_list list = {0, 0, 0};
    const uint cell = longer[i];
#if CELLIST_MODES == CELLIST_LINKED
    list.length = cellist_sort_chain(lists_view, i, segments, offsets);
    list.first = atomic_add(&state->nodes, list.length);
#else
    list.length = cellist_sort_length(lists_heads, lists_view, cell);
    list.first = cellist_begin(lists_heads, lists_view, cell);
    atomic_add(&state->nodes, list.length);
#endif
    const uint chunks = (list.length + (CELLIST_SORT_CHUNK_SIZE - 1)) / CELLIST_SORT_CHUNK_SIZE;
    list.chunk = atomic_add(&state->chunks, chunks);
    if (list.length == 0 || list.length > lists_view.pool_nodes ||
        list.first > lists_view.pool_nodes - list.length || list.chunk > chunks_max - chunks) {
        atomic_inc(&state->broken);
        list.length = 0;
    } else {
        atomic_max(&state->longest, list.length);
        for (uint chunk = 0; chunk < chunks; ++chunk) chunk_owners[list.chunk + chunk] = i;
#if CELLIST_MODES == CELLIST_LINKED
        heads[cell] = list.first;
#endif
    }
    long_lists[i] = list;
}

#if CELLIST_MODES == CELLIST_LINKED

// Copies the nodes of the lists; work-items as in cellist_sort_measure.
kernel void cellist_sort_gather(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* longer,
                                uint count, global const cellist_sort_long_list* long_lists,
                                global const uint2* segments, global const uint2* offsets,
                                global cellist_sort_node* nodes) {
    const cellist_view lists_view = cellist_view_of(lists);
    const ulong end = (ulong)cellist_sort_splitters(lists_view) + count;
    const ulong begin = (ulong)get_global_id(0) * CELLIST_SORT_LISTS;
    if (begin >= end) return;
    const uint own = (uint)min(end - begin, (ulong)CELLIST_SORT_LISTS);
    uint next[CELLIST_SORT_LISTS];
    uint at[CELLIST_SORT_LISTS];
    uint ends[CELLIST_SORT_LISTS];
    uint lasts[CELLIST_SORT_LISTS];
    for (uint i = 0; i < own; ++i) {
        const uint2 offset = offsets[begin + i];
        next[i] = CELLIST_NONE;
        if (offset.x >= count) continue;
        const cellist_sort_long_list list = long_lists[offset.x];
        const uint length = segments[begin + i].x;
        if (offset.y > list.length || length > list.length - offset.y) continue;
        next[i] = cellist_sort_segment_begin(CELLIST_PASS(lists), longer, (uint)begin + i);
        at[i] = list.first + offset.y;
        ends[i] = at[i] + length;
        lasts[i] = list.first + list.length - 1;
    }
    for (uint step = 0; step < CELLIST_SORT_SEGMENT_MAX; ++step) {
        uint more = 0;
        for (uint i = 0; i < own; ++i) {
            const uint node = next[i];
            if (node >= lists_view.pool_nodes || at[i] == ends[i]) continue;
            next[i] = lists_nodes[node].next;
            cellist_sort_store(nodes, at[i], lasts[i],
                               (global const cellist_sort_node*)lists_nodes + node);
            ++at[i];
            more = 1;
        }
        if (!more) break;
    }
}

#endif

// The key of node i.
#if CELLIST_SORT_KEEPS_KEYS
#define cellist_sort_key_of(nodes, keys, i) ((keys)[i])
#else
#define cellist_sort_key_of(nodes, keys, i)                                                        \
    cellist_sort_key(&cellist_sort_record((nodes)[i]), values)
#endif

// The key by which a merge orders node i: on CPUs with a word of the record, where there is room,
// so that few comparisons branch.
#if CELLIST_SORT_ITEMS == 1 && CELLIST_SORT_KEY_BITS == 32
typedef ulong cellist_sort_merge_bits;
#define cellist_sort_merge_key(nodes, keys, i)                                                     \
    ((ulong)cellist_sort_key_of(nodes, keys, i) << 32 |                                            \
     cellist_sort_word(&cellist_sort_record((nodes)[i]), 0))
#else
typedef cellist_sort_bits cellist_sort_merge_bits;
#define cellist_sort_merge_key(nodes, keys, i) cellist_sort_key_of(nodes, keys, i)
#endif

// Sorts each chunk; CELLIST_SORT_ITEMS work-items a chunk.
CELLIST_SORT_KERNEL cellist_sort_chunks(global const cellist_sort_long_list* long_lists,
                                        global const uint* chunk_owners, uint chunks,
                                        global cellist_sort_node* nodes,
                                        global cellist_sort_bits* kept_keys,
                                        volatile global cellist_sort_state* state,
                                        const cellist_values values) {
    CELLIST_SORT_SHARED cellist_sort_bits keys[CELLIST_SORT_CHUNK_SIZE];
    CELLIST_SORT_SHARED uchar order[CELLIST_SORT_CHUNK_SIZE];
    CELLIST_SORT_SHARED uint sum;
    const uint item = cellist_sort_item();
    const uint chunk = (uint)(get_global_id(0) / CELLIST_SORT_ITEMS);
    uint first = 0;
    uint last = 0;
    uint length = 0;
    if (chunk < chunks) {
        const cellist_sort_long_list list = long_lists[chunk_owners[chunk]];
        const uint begin = (chunk - list.chunk) * CELLIST_SORT_CHUNK_SIZE;
        first = list.first + begin;
        last = list.first + list.length - 1;
        length = min(list.length - begin, (uint)CELLIST_SORT_CHUNK_SIZE);
    }
    if (item == 0) sum = 0;
    for (uint i = item; i < length; i += CELLIST_SORT_ITEMS) {
        global const CELLIST_RECORD_TYPE* record = &cellist_sort_record(nodes[first + i]);
        keys[i] = cellist_sort_add_word(cellist_sort_key(record, values), record);
    }
    cellist_sort_barrier();
    const cellist_sort_ties known_ties = cellist_sort_known_ties(state);
    cellist_sort_ties ties = known_ties;
    const int expects_ties = cellist_sort_expects_ties(&ties);
    uint ranks[CELLIST_SORT_RUNS * CELLIST_SORT_WIDTH];
    if (!expects_ties) cellist_sort_add(&sum, cellist_sort_rank(keys, length, item, ranks));
    cellist_sort_barrier();
    const int unique = !expects_ties && cellist_sort_unique(sum, length);
    if (!expects_ties) cellist_sort_note_ties(&ties, length, unique);
    if (unique)
        cellist_sort_order(ranks, length, item, order);
    else
        cellist_sort_order_equal(nodes, first, 0, keys, length, item, &ties, ranks, order);
    cellist_sort_tell_ties(state, &known_ties, &ties);
    cellist_sort_barrier();
#if CELLIST_SORT_KEEPS_KEYS
    for (uint i = item; i < length; i += CELLIST_SORT_ITEMS) kept_keys[first + i] = keys[order[i]];
#endif
    cellist_sort_permute(nodes, first, last, length, item, order);
}

// How many of the first `taken` nodes of two sorted runs together are of the first run (Odeh,
// Green, Mwassi, Shmueli, Birk: "Merge Path", IPDPSW 2012). The runs are nodes first ... middle - 1
// and middle ... end - 1.
static inline uint cellist_sort_split(global const cellist_sort_node* nodes,
                                      global const cellist_sort_bits* keys, uint first, uint middle,
                                      uint end, uint taken, const cellist_values values) {
    uint least = taken > end - middle ? taken - (end - middle) : 0;
    uint most = min(taken, middle - first);
    while (least < most) {
        const uint probe = least + (most - least) / 2;
        const uint x = first + probe;
        const uint y = middle + (taken - 1 - probe);
        if (cellist_sort_before(&cellist_sort_record(nodes[y]), cellist_sort_key_of(nodes, keys, y),
                                &cellist_sort_record(nodes[x]),
                                cellist_sort_key_of(nodes, keys, x)))
            most = probe;
        else
            least = probe + 1;
    }
    return least;
}

// Merges pairs of runs of `run` nodes; a work-item writes CELLIST_SORT_MERGE_ITEMS nodes of a list,
// a power of two.
kernel void cellist_sort_merge_runs(global const cellist_sort_long_list* long_lists,
                                    global const uint* chunk_owners, uint chunks,
                                    global const cellist_sort_node* from,
                                    global cellist_sort_node* to, uint run,
                                    global const cellist_sort_bits* keys_from,
                                    global cellist_sort_bits* keys_to,
                                    const cellist_values values) {
    const uint per_chunk = max(CELLIST_SORT_CHUNK_SIZE / CELLIST_SORT_MERGE_ITEMS, 1);
    const ulong item = get_global_id(0);
    if (item >= (ulong)chunks * per_chunk) return;
    const uint chunk = (uint)(item / per_chunk);
    const cellist_sort_long_list list = long_lists[chunk_owners[chunk]];
    const uint begin = (chunk - list.chunk) * CELLIST_SORT_CHUNK_SIZE +
                       (uint)(item % per_chunk) * CELLIST_SORT_MERGE_ITEMS;
    if (run >= list.length || begin >= list.length || begin % CELLIST_SORT_MERGE_ITEMS != 0) return;
    const uint end = min(list.length - begin, (uint)CELLIST_SORT_MERGE_ITEMS) + begin;
    from += list.first;
    keys_from += list.first;
    keys_to += list.first;

    for (uint at = begin; at < end;) {
        const uint first = (uint)(at - at % (2 * (ulong)run));
        const uint a_end = first + min(list.length - first, run);
        const uint b_end = a_end + min(list.length - a_end, run);
        uint a =
            first + cellist_sort_split(from, keys_from, first, a_end, b_end, at - first, values);
        uint b = a_end + at - a;
        const uint stop = min(end, b_end);
        // As many steps at a time as neither run ends in. They compute instead of branching: no
        // processor foresees which run is next.
        while (at < stop && a < a_end && b < b_end) {
            const uint last = at + min(stop - at, min(a_end - a, b_end - b));
            for (; at < last; ++at) {
                const cellist_sort_merge_bits x = cellist_sort_merge_key(from, keys_from, a);
                const cellist_sort_merge_bits y = cellist_sort_merge_key(from, keys_from, b);
                uint b_first = y < x;
                if (x == y)
                    b_first = cellist_record_before(&cellist_sort_record(from[b]),
                                                    &cellist_sort_record(from[a]), 0);
                cellist_sort_store(to, list.first + at, list.first + list.length - 1,
                                   &from[a + ((b - a) & (0 - b_first))]);
#if CELLIST_SORT_KEEPS_KEYS
                keys_to[at] = b_first ? y : x;
#endif
                a += 1 - b_first;
                b += b_first;
            }
        }
        for (; at < stop; ++at) {
            const uint next = a < a_end ? a++ : b++;
            cellist_sort_store(to, list.first + at, list.first + list.length - 1, &from[next]);
#if CELLIST_SORT_KEEPS_KEYS
            keys_to[at] = keys_from[next];
#endif
        }
    }
}

// Copies the lists whose last pass left them in the other pool; one work-item per node.
kernel void cellist_sort_return(global const cellist_sort_long_list* long_lists,
                                global const uint* chunk_owners, uint chunks,
                                global const cellist_sort_node* from,
                                global cellist_sort_node* to) {
    const ulong item = get_global_id(0);
    if (item >= (ulong)chunks * CELLIST_SORT_CHUNK_SIZE) return;
    const uint chunk = (uint)(item / CELLIST_SORT_CHUNK_SIZE);
    const cellist_sort_long_list list = long_lists[chunk_owners[chunk]];
    const uint at =
        (chunk - list.chunk) * CELLIST_SORT_CHUNK_SIZE + (uint)(item % CELLIST_SORT_CHUNK_SIZE);
    if (at >= list.length) return;
    uint odd = 0;
    for (ulong run = CELLIST_SORT_CHUNK_SIZE; run < list.length; run *= 2) odd = !odd;
    if (odd) to[list.first + at] = from[list.first + at];
}
