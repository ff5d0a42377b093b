// Sorts long lists with all work-items together: chunks of CELLIST_SORT_SLOTS records are ranked, then
// merged in passes. See sort.cl.
//
// Linked lists are sorted as items in scratch memory, a key and a node each, and relinked. They are
// collected in parallel: some nodes are splitters, one in each 2^CELLIST_SORT_PART_BITS nodes of the
// pool, at a place that depends on a hash, and a list consists of parts, each from the head or a
// splitter to the next splitter (Helman, JaJa: "Designing Practical Efficient Algorithms for Symmetric
// Multiprocessors", ALENEX 1999, section 4). Records of lists in one piece are the items themselves, and
// every second pass writes to scratch memory.
//
//   longer   lists                the cells
//   parts    splitters + lists    a part's nodes, and the part behind it or CELLIST_NONE; the last
//                                 ones begin at the heads
//   places   splitters + lists    the list of a part or CELLIST_NONE, its nodes before the part
//   longs    lists                where each list is
//   owners   state->chunks        the list of each chunk; the host has no more than `owners_end`
//   broken   lists                cells whose links the parts do not follow: they are left as they are
//   scratch, other                CELLIST_SORT_SLOTS items a chunk; `other` where lists are linked
//
// Every loop is bounded, and no link leads outside of the pool, whatever the links are.

#define CELLIST_SORT_PART_BITS 9u
// A part of a sound list is longer once in e^64 times.
#define CELLIST_SORT_PART_MAX (64u << CELLIST_SORT_PART_BITS)
// The part behind a part that is longer.
#define CELLIST_SORT_BROKEN (CELLIST_NONE - 1u)

#if CELLIST_MODES == CELLIST_LINKED
typedef struct cellist_sort_entry {
    cellist_sort_bits key;
    uint node;
} cellist_sort_item_type;
#else
typedef CELLIST_RECORD cellist_sort_item_type;
#endif

// The items of a list before or after a pass.
static inline global cellist_sort_item_type* cellist_sort_items(
    CELLIST_LISTS(CELLIST_RECORD, lists), cellist_sort_long list,
    global cellist_sort_item_type* scratch, global cellist_sort_item_type* other, uint odd) {
    const ulong at = (ulong)list.chunk * CELLIST_SORT_SLOTS;
#if CELLIST_MODES == CELLIST_LINKED
    return (odd ? other : scratch) + at;
#else
    return odd ? scratch + at : &cellist_get(lists, list.first);
#endif
}

static inline cellist_sort_bits cellist_sort_item_key(cellist_sort_item_type item) {
#if CELLIST_MODES == CELLIST_LINKED
    return item.key;
#else
    return cellist_sort_key(item);
#endif
}

// Whether item a, with key x, comes before item b, with key y.
static inline int cellist_sort_item_before(CELLIST_LISTS(CELLIST_RECORD, lists),
                                           cellist_sort_item_type a, cellist_sort_bits x,
                                           cellist_sort_item_type b, cellist_sort_bits y) {
    if (x != y) return x < y;
#if CELLIST_MODES == CELLIST_LINKED
    return cellist_record_before(cellist_get(lists, a.node), cellist_get(lists, b.node), 0);
#else
    return cellist_record_before(a, b, 0);
#endif
}

#if CELLIST_MODES == CELLIST_LINKED

static inline uint cellist_sort_splitters(const cellist_view view) {
    return view.capacity_nodes >> CELLIST_SORT_PART_BITS;
}

static inline uint cellist_sort_splitter(uint part) {
    const uint hash = part * 0x9E3779B1u >> (32u - CELLIST_SORT_PART_BITS);
    return (part << CELLIST_SORT_PART_BITS) + hash;
}

static inline int cellist_sort_is_splitter(const cellist_view view, uint node) {
    const uint part = node >> CELLIST_SORT_PART_BITS;
    return part < cellist_sort_splitters(view) && node == cellist_sort_splitter(part);
}

static inline uint cellist_sort_part_begin(CELLIST_LISTS(CELLIST_RECORD, lists),
                                           global const uint* longer, uint part) {
    const uint splitters = cellist_sort_splitters(lists_view);
    return part < splitters ? cellist_sort_splitter(part) : lists_heads[longer[part - splitters]];
}

// How long each part is. A work-item follows CELLIST_SORT_LISTS parts at a time.
kernel void cellist_sort_measure(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* longer,
                                 uint count, global uint2* parts) {
    const uint splitters = cellist_sort_splitters(lists_view);
    const ulong end = (ulong)splitters + count;
    const ulong begin = (ulong)get_global_id(0) * CELLIST_SORT_LISTS;
    if (begin >= end) return;
    const uint own = (uint)min(end - begin, (ulong)CELLIST_SORT_LISTS);
    uint nodes[CELLIST_SORT_LISTS];
    uint lengths[CELLIST_SORT_LISTS];
    for (uint i = 0; i < own; ++i) {
        const uint part = (uint)begin + i;
        nodes[i] = cellist_sort_part_begin(CELLIST_PASS(lists), longer, part);
        lengths[i] = part < splitters;
        if (part < splitters) nodes[i] = lists_nodes[nodes[i]].next;
    }
    for (uint step = 0; step < CELLIST_SORT_PART_MAX; ++step) {
        uint more = 0;
        for (uint i = 0; i < own; ++i) {
            const uint node = nodes[i];
            if (node >= lists_view.capacity_nodes || cellist_sort_is_splitter(lists_view, node))
                continue;
            nodes[i] = lists_nodes[node].next;
            ++lengths[i];
            more = 1;
        }
        if (!more) break;
    }
    for (uint i = 0; i < own; ++i) {
        uint next = CELLIST_NONE;
        if (nodes[i] < lists_view.capacity_nodes)
            next = cellist_sort_is_splitter(lists_view, nodes[i])
                       ? nodes[i] >> CELLIST_SORT_PART_BITS
                       : CELLIST_SORT_BROKEN;
        parts[begin + i] = (uint2)(lengths[i], next);
    }
}

// Where each part of a list goes. Returns the length of the list, 0 if it is broken.
static inline uint cellist_sort_chain(CELLIST_LISTS(CELLIST_RECORD, lists), uint list,
                                      global const uint2* parts, global uint2* places) {
    const uint splitters = cellist_sort_splitters(lists_view);
    uint part = splitters + list;
    uint length = 0;
    for (uint step = 0; step <= splitters; ++step) {
        places[part] = (uint2)(list, length);
        const uint2 own = parts[part];
        length += own.x;
        if (length > lists_view.capacity_nodes) return 0;
        if (own.y == CELLIST_NONE) return length;
        if (own.y == CELLIST_SORT_BROKEN) return 0;
        part = own.y;
    }
    return 0;
}

#endif

// Gives each list its chunks; one work-item a list.
kernel void cellist_sort_place(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* longer,
                               uint count, global const uint2* parts, global uint2* places,
                               global cellist_sort_long* longs, global uint* owners, uint owners_end,
                               global uint* broken, volatile global cellist_sort_state* state) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_sort_long list = {longer[i], 0, 0, 0};
#if CELLIST_MODES == CELLIST_LINKED
    list.length = cellist_sort_chain(CELLIST_PASS(lists), i, parts, places);
#else
    list.first = cellist_begin(lists_heads, lists_view, list.cell);
    list.length = cellist_sort_length(lists_heads, lists_view, list.cell);
#endif
    const uint chunks = (uint)(((ulong)list.length + CELLIST_SORT_SLOTS - 1) / CELLIST_SORT_SLOTS);
    list.chunk = atomic_add(&state->chunks, chunks);
    if (list.length == 0 || (ulong)list.chunk + chunks > owners_end) {
        list.length = 0;
        broken[atomic_inc(&state->broken)] = list.cell;
    } else {
        atomic_max(&state->longest_chunks, chunks);
        for (uint chunk = 0; chunk < chunks; ++chunk) owners[list.chunk + chunk] = i;
    }
    longs[i] = list;
}

#if CELLIST_MODES == CELLIST_LINKED

// Collects the nodes of the lists; work-items as in cellist_sort_measure.
kernel void cellist_sort_collect(CELLIST_LISTS(CELLIST_RECORD, lists), global const uint* longer,
                                 uint count, global const uint2* parts, global const uint2* places,
                                 global const cellist_sort_long* longs,
                                 global cellist_sort_item_type* scratch) {
    const ulong end = (ulong)cellist_sort_splitters(lists_view) + count;
    const ulong begin = (ulong)get_global_id(0) * CELLIST_SORT_LISTS;
    if (begin >= end) return;
    const uint own = (uint)min(end - begin, (ulong)CELLIST_SORT_LISTS);
    uint nodes[CELLIST_SORT_LISTS];
    uint lengths[CELLIST_SORT_LISTS];
    ulong at[CELLIST_SORT_LISTS];
    for (uint i = 0; i < own; ++i) {
        const uint2 place = places[begin + i];
        nodes[i] = CELLIST_NONE;
        if (place.x >= count) continue;
        const cellist_sort_long list = longs[place.x];
        lengths[i] = parts[begin + i].x;
        if (place.y > list.length || lengths[i] > list.length - place.y) continue;
        nodes[i] = cellist_sort_part_begin(CELLIST_PASS(lists), longer, (uint)begin + i);
        at[i] = (ulong)list.chunk * CELLIST_SORT_SLOTS + place.y;
    }
    for (uint step = 0; step < CELLIST_SORT_PART_MAX; ++step) {
        uint more = 0;
        for (uint i = 0; i < own; ++i) {
            const uint node = nodes[i];
            if (node >= lists_view.capacity_nodes || step >= lengths[i]) continue;
            const cellist_sort_item_type item = {cellist_sort_key(cellist_get(lists, node)), node};
            scratch[at[i] + step] = item;
            nodes[i] = lists_nodes[node].next;
            more = 1;
        }
        if (!more) break;
    }
}

#endif

// Sorts each chunk; CELLIST_SORT_ITEMS work-items a chunk.
CELLIST_SORT_KERNEL cellist_sort_chunks(CELLIST_LISTS(CELLIST_RECORD, lists),
                                        global const cellist_sort_long* longs,
                                        global const uint* owners, uint chunks,
                                        global cellist_sort_item_type* scratch) {
    CELLIST_SORT_SHARED cellist_sort_bits keys[CELLIST_SORT_SLOTS];
    CELLIST_SORT_SHARED uchar order[CELLIST_SORT_SLOTS];
    CELLIST_SORT_SHARED uint places[1];
#if CELLIST_MODES == CELLIST_LINKED
    CELLIST_SORT_SHARED uint nodes[CELLIST_SORT_SLOTS];
#else
    CELLIST_SORT_SHARED uint* nodes = 0;
#endif
    const uint item = cellist_sort_item();
    const uint chunk = get_global_id(0) / CELLIST_SORT_ITEMS;
    if (item == 0) places[0] = 0;
    cellist_sort_long list = {0, 0, 0, 0};
    if (chunk < chunks) list = longs[owners[chunk]];
    const uint begin = (chunk - list.chunk) * CELLIST_SORT_SLOTS;
    const uint length = list.length == 0 ? 0 : min(list.length - begin, (uint)CELLIST_SORT_SLOTS);
    global cellist_sort_item_type* items =
        cellist_sort_items(CELLIST_PASS(lists), list, scratch, scratch, 0) + begin;
    for (uint i = item; i < length; i += CELLIST_SORT_ITEMS) {
        const cellist_sort_item_type own = items[i];
        keys[i] = cellist_sort_item_key(own);
#if CELLIST_MODES == CELLIST_LINKED
        nodes[i] = own.node;
#endif
    }
    cellist_sort_barrier();
    for (uint at = item * CELLIST_SORT_WIDTH; at < length;
         at += CELLIST_SORT_ITEMS * CELLIST_SORT_WIDTH)
        cellist_sort_add(places, cellist_sort_rank(keys, length, at, order));
    cellist_sort_barrier();
    if (length > 0 && places[0] != length * (length - 1) / 2)
        for (uint at = item * CELLIST_SORT_WIDTH; at < length;
             at += CELLIST_SORT_ITEMS * CELLIST_SORT_WIDTH)
            cellist_sort_rank_equal(CELLIST_PASS(lists), keys, nodes, list.first + begin, length, at,
                                    order);
    cellist_sort_barrier();
    cellist_sort_item_type sorted[CELLIST_SORT_SLOTS / CELLIST_SORT_ITEMS];
    for (uint i = 0; i < CELLIST_SORT_SLOTS / CELLIST_SORT_ITEMS; ++i) {
        const uint at = item + i * CELLIST_SORT_ITEMS;
        if (at >= length) break;
        sorted[i] = items[order[at]];
    }
    cellist_sort_barrier();
    for (uint i = 0; i < CELLIST_SORT_SLOTS / CELLIST_SORT_ITEMS; ++i) {
        const uint at = item + i * CELLIST_SORT_ITEMS;
        if (at >= length) break;
        items[at] = sorted[i];
    }
}

// How many of the first `taken` items of two sorted runs together are of the first run (Odeh, Green,
// Mwassi, Shmueli, Birk: "Merge Path", IPDPSW 2012).
static inline uint cellist_sort_split(CELLIST_LISTS(CELLIST_RECORD, lists),
                                      global const cellist_sort_item_type* a, uint a_length,
                                      global const cellist_sort_item_type* b, uint b_length,
                                      uint taken) {
    uint least = taken > b_length ? taken - b_length : 0;
    uint most = min(taken, a_length);
    while (least < most) {
        const uint middle = least + (most - least) / 2;
        const cellist_sort_item_type x = a[middle];
        const cellist_sort_item_type y = b[taken - 1 - middle];
        if (cellist_sort_item_before(CELLIST_PASS(lists), y, cellist_sort_item_key(y), x,
                                     cellist_sort_item_key(x)))
            most = middle;
        else
            least = middle + 1;
    }
    return least;
}

// Merges pairs of runs of `run` items; a work-item writes CELLIST_SORT_SHARE items of a list, a power of
// two.
kernel void cellist_sort_merge(CELLIST_LISTS(CELLIST_RECORD, lists),
                               global const cellist_sort_long* longs, global const uint* owners,
                               uint chunks, global cellist_sort_item_type* scratch,
                               global cellist_sort_item_type* other, uint run, uint odd) {
    const uint per_chunk = max(CELLIST_SORT_SLOTS / CELLIST_SORT_SHARE, 1);
    const ulong item = get_global_id(0);
    if (item >= (ulong)chunks * per_chunk) return;
    const uint chunk = (uint)(item / per_chunk);
    const cellist_sort_long list = longs[owners[chunk]];
    const uint begin = (chunk - list.chunk) * CELLIST_SORT_SLOTS +
                       (uint)(item % per_chunk) * CELLIST_SORT_SHARE;
    if (run >= list.length || begin >= list.length || begin % CELLIST_SORT_SHARE != 0) return;
    const uint end = min(list.length - begin, (uint)CELLIST_SORT_SHARE) + begin;
    global cellist_sort_item_type* from =
        cellist_sort_items(CELLIST_PASS(lists), list, scratch, other, odd);
    global cellist_sort_item_type* to =
        cellist_sort_items(CELLIST_PASS(lists), list, scratch, other, !odd);

    for (uint at = begin; at < end;) {
        const uint first = (uint)(at - at % (2 * (ulong)run));
        const uint a_end = first + min(list.length - first, run);
        const uint b_end = a_end + min(list.length - a_end, run);
        uint a = first + cellist_sort_split(CELLIST_PASS(lists), from + first, a_end - first,
                                            from + a_end, b_end - a_end, at - first);
        uint b = a_end + at - a;
        const uint stop = min(end, b_end);
        // As many steps at a time as neither run ends in. Arithmetic instead of choices: what is next is
        // anyone's guess.
        while (at < stop && a < a_end && b < b_end) {
            const uint steps = min(stop - at, min(a_end - a, b_end - b));
            for (uint step = 0; step < steps; ++step) {
                const cellist_sort_item_type x = from[a];
                const cellist_sort_item_type y = from[b];
                const cellist_sort_bits x_key = cellist_sort_item_key(x);
                const cellist_sort_bits y_key = cellist_sort_item_key(y);
                uint b_first = y_key < x_key;
                if (x_key == y_key)
                    b_first = cellist_sort_item_before(CELLIST_PASS(lists), y, y_key, x, x_key);
                to[at + step] = from[a + ((b - a) & (0 - b_first))];
                a += 1 - b_first;
                b += b_first;
            }
            at += steps;
        }
        for (; at < stop && a < a_end; ++at) to[at] = from[a++];
        for (; at < stop; ++at) to[at] = from[b++];
    }
}

// Links the nodes in their order, or copies the records that the last pass left in scratch memory;
// one work-item an item.
kernel void cellist_sort_finish(CELLIST_LISTS(CELLIST_RECORD, lists),
                                global const cellist_sort_long* longs, global const uint* owners,
                                uint chunks, global cellist_sort_item_type* scratch,
                                global cellist_sort_item_type* other) {
    const ulong item = get_global_id(0);
    if (item >= (ulong)chunks * CELLIST_SORT_SLOTS) return;
    const uint chunk = (uint)(item / CELLIST_SORT_SLOTS);
    const cellist_sort_long list = longs[owners[chunk]];
    const uint at = (chunk - list.chunk) * CELLIST_SORT_SLOTS + (uint)(item % CELLIST_SORT_SLOTS);
    if (at >= list.length) return;
    uint odd = 0;
    for (ulong run = CELLIST_SORT_SLOTS; run < list.length; run *= 2) odd = !odd;
    global const cellist_sort_item_type* items =
        cellist_sort_items(CELLIST_PASS(lists), list, scratch, other, odd);
#if CELLIST_MODES == CELLIST_LINKED
    const uint node = items[at].node;
    if (node >= lists_view.capacity_nodes) return;
    if (at == 0) lists_heads[list.cell] = node;
    lists_nodes[node].next = at + 1 < list.length ? items[at + 1].node : CELLIST_NONE;
#else
    if (odd) cellist_get(lists, list.first + at) = items[at];
#endif
}
