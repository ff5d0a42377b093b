// SPDX-License-Identifier: MIT
// Orders the records of a list that has equal keys: by the key, then by the record's scalars. See
// sort.cl.
//
// Where one work-item sorts a list (CPUs), it ranks the list again, by keys with more words:
//
//   key, word l                   for keys of 32 bits. Level l is 0, or a later word if the words
//                                 before it were the same in all ties so far
//   rank, word l + 1, part of the next word
//
// Each step takes as long as the first ranking. Records that are still equal are merged by their
// whole values. Afterwards the work-item checks the assumption about the words before l, and starts
// again if it does not hold. So the order never depends on what was found before.
//
// If the first lists of a sort have ties, the others skip the ranking by the key alone.

// Words of a record that count as levels. Merges compare the others.
#define CELLIST_SORT_LEVELS 8u

// Lists that decide whether ties are expected in the others, and their least length.
#define CELLIST_SORT_SAMPLES 64u
#define CELLIST_SORT_SAMPLE_LENGTH 8u

// A key of 32 bits that is kept in 64 bits has room for a word of the record.
static inline int cellist_sort_has_room(void) {
    return CELLIST_SORT_KEY_BITS == 64 && cellist_sort_key_bytes() <= 4;
}

static inline cellist_sort_bits cellist_sort_add_word(cellist_sort_bits key,
                                                      global const CELLIST_RECORD_TYPE* record) {
#if CELLIST_SORT_KEY_BITS == 64
    if (cellist_sort_has_room()) return key << 32 | cellist_sort_word(record, 0);
#endif
    return key;
}

static inline cellist_sort_bits cellist_sort_without_word(cellist_sort_bits key) {
#if CELLIST_SORT_KEY_BITS == 64
    if (cellist_sort_has_room()) return key >> 32;
#endif
    return key;
}

// What is known about ties at first. Other work-items change it meanwhile: it affects the time
// alone. Nothing on GPUs, which do not use it: all work-items would read the same words.
static inline cellist_sort_ties cellist_sort_known_ties(volatile global cellist_sort_state* state) {
    cellist_sort_ties ties = {0, 0, 0};
    if (CELLIST_SORT_ITEMS > 1) return ties;
    ties.ranked_lists = state->ties.ranked_lists;
    ties.tied_lists = state->ties.tied_lists;
    ties.tie_level = state->ties.tie_level;
    return ties;
}

static inline int cellist_sort_expects_ties(const cellist_sort_ties* ties) {
    return CELLIST_SORT_ITEMS == 1 && cellist_sort_key_bytes() <= 4 && ties->tied_lists > 0 &&
           ties->tied_lists * 4 >= ties->ranked_lists;
}

// Takes note of a list that was ranked by its keys alone.
static inline void cellist_sort_note_ties(cellist_sort_ties* ties, uint length, int unique) {
    if (length < CELLIST_SORT_SAMPLE_LENGTH) return;
    ++ties->ranked_lists;
    ties->tied_lists += !unique;
}

// Tells other work-items what this one has found.
static inline void cellist_sort_tell_ties(volatile global cellist_sort_state* state,
                                          const cellist_sort_ties* known,
                                          const cellist_sort_ties* found) {
    if (CELLIST_SORT_ITEMS > 1) return;
    if (found->tie_level != known->tie_level) atomic_xchg(&state->ties.tie_level, found->tie_level);
    if (known->ranked_lists >= CELLIST_SORT_SAMPLES) return;
    if (found->ranked_lists != known->ranked_lists)
        atomic_add(&state->ties.ranked_lists, found->ranked_lists - known->ranked_lists);
    if (found->tied_lists != known->tied_lists)
        atomic_add(&state->ties.tied_lists, found->tied_lists - known->tied_lists);
}

// Record i of a list is nodes[first + i], or nodes[index[i]] where `first` is CELLIST_NONE. The
// index itself does not tell, because an array in local memory may have the address 0.
#define cellist_sort_at(i)                                                                         \
    (&cellist_sort_record(nodes[first == CELLIST_NONE ? index[i] : first + (i)]))

// One work-item adds words to the keys of a list, where there is room.
static inline void cellist_sort_add_first_word(global const cellist_sort_node* nodes, uint first,
                                               CELLIST_SORT_SHARED const uint* index,
                                               CELLIST_SORT_SHARED cellist_sort_bits* keys,
                                               uint length) {
    if (CELLIST_SORT_ITEMS > 1 || !cellist_sort_has_room()) return;
    for (uint i = 0; i < length; ++i) keys[i] = cellist_sort_add_word(keys[i], cellist_sort_at(i));
}

#if CELLIST_SORT_ITEMS > 1

// Writes the order where keys may be equal. Equal records stay in theirs.
//
// Has the parameters that processors need, but does not read `ranks`: an index that is not constant
// would force the array out of registers, also for lists without equal keys. The work-items of a
// warp look for their next equal keys together, and then compare records together.
static void cellist_sort_order_equal(global const cellist_sort_node* nodes, uint first,
                                     local const uint* index, local const cellist_sort_bits* keys,
                                     uint length, uint member, cellist_sort_ties* ties,
                                     const uint* ranks, local uchar* order) {
    cellist_sort_each_run(n, at, member, length) {
        for (uint i = at; i < at + CELLIST_SORT_WIDTH && i < length; ++i) {
            const cellist_sort_bits key = keys[i];
            uint rank = 0;
            for (uint j = 0; j < length; ++j) {
                for (; j < length && (keys[j] != key || j == i); ++j) rank += keys[j] < key;
                if (j == length) break;
                rank +=
                    cellist_record_before(cellist_sort_at(j), cellist_sort_at(i), 0) ||
                    (j < i && !cellist_record_before(cellist_sort_at(i), cellist_sort_at(j), 0));
            }
            order[rank] = (uchar)i;
        }
    }
}

#else

// Finds ranks as cellist_sort_rank does. Returns whether no two keys are equal.
static inline int cellist_sort_rank_wide(const ulong* keys, uint length, uint* ranks) {
    typedef CELLIST_SORT_PASTE(ulong, CELLIST_SORT_WIDTH) vector_of_bits;
    typedef CELLIST_SORT_PASTE(long, CELLIST_SORT_WIDTH) vector_of_counts;
    uint sum = 0;
    for (uint at = 0; at < length; at += CELLIST_SORT_WIDTH) {
        const vector_of_bits own = CELLIST_SORT_PASTE(vload, CELLIST_SORT_WIDTH)(0, keys + at);
        vector_of_counts before = 0;
        for (uint i = 0; i < length; ++i) before -= (vector_of_bits)keys[i] < own;
        CELLIST_SORT_PASTE(vstore, CELLIST_SORT_WIDTH)
        (CELLIST_SORT_PASTE(convert_uint, CELLIST_SORT_WIDTH)(before), 0, ranks + at);
        for (uint i = 0; i < CELLIST_SORT_WIDTH && at + i < length; ++i) sum += ranks[at + i];
    }
    return cellist_sort_unique(sum, length);
}

// Sorts records by their scalars, by merges.
static void cellist_sort_merge(global const cellist_sort_node* nodes, uint first, const uint* index,
                               uint length, uchar* records) {
    uchar others[CELLIST_SORT_CHUNK_SIZE];
    uchar* from = records;
    uchar* to = others;
    for (uint width = 1; width < length; width *= 2) {
        for (uint begin = 0; begin < length; begin += 2 * width) {
            const uint middle = min(begin + width, length);
            const uint end = min(middle + width, length);
            uint a = begin;
            uint b = middle;
            for (uint at = begin; at < end; ++at)
                to[at] =
                    b == end || (a < middle && !cellist_record_before(cellist_sort_at(from[b]),
                                                                      cellist_sort_at(from[a]), 0))
                        ? from[a++]
                        : from[b++];
        }
        uchar* const sorted = to;
        to = from;
        from = sorted;
    }
    if (from == records) return;
    for (uint i = 0; i < length; ++i) records[i] = from[i];
}

// Writes the order by ranks, where some ranks are equal.
static void cellist_sort_merge_equal(global const cellist_sort_node* nodes, uint first,
                                     const uint* index, const uint* ranks, uint length,
                                     uchar* order) {
    uint counts[CELLIST_SORT_CHUNK_SIZE];
    for (uint i = 0; i < length; ++i) counts[i] = 0;
    for (uint i = 0; i < length; ++i) order[ranks[i] + counts[ranks[i]]++] = (uchar)i;
    for (uint begin = 0; begin < length; begin += counts[begin])
        if (counts[begin] > 1)
            cellist_sort_merge(nodes, first, index, counts[begin], order + begin);
}

// The first level at which two records differ that are neighbours in an order and have equal keys,
// or `most` if there is none before that.
static uint cellist_sort_first_difference(global const cellist_sort_node* nodes, uint first,
                                          const uint* index, const cellist_sort_bits* keys,
                                          uint length, const uchar* order, uint most) {
    uint begin = 0;
#if CELLIST_SORT_KEY_BITS == 64
    // The keys have the first word: this loop does not branch.
    if (cellist_sort_has_room() && most > 0) {
        ulong sorted[CELLIST_SORT_CHUNK_SIZE];
        for (uint i = 0; i < length; ++i) sorted[i] = keys[order[i]];
        uint differs = 0;
        for (uint i = 1; i < length; ++i) {
            const ulong difference = sorted[i - 1] ^ sorted[i];
            differs |= (difference >> 32 == 0) & (difference != 0);
        }
        if (differs) return 0;
        begin = 1;
    }
#endif
    if (begin == most) return most;
    for (uint i = 1; i < length; ++i) {
        const uint a = order[i - 1];
        const uint b = order[i];
        if (cellist_sort_without_word(keys[a]) != cellist_sort_without_word(keys[b])) continue;
        for (uint level = begin; level < most; ++level)
            if (cellist_sort_word(cellist_sort_at(a), level) !=
                cellist_sort_word(cellist_sort_at(b), level))
                most = level;
    }
    return most;
}

// Keys of up to 32 bits, each with a word. Constant levels are faster: records mostly differ there.
static inline void cellist_sort_add_words(global const cellist_sort_node* nodes, uint first,
                                          const uint* index, const cellist_sort_bits* keys,
                                          uint length, uint level, ulong* words) {
#define CELLIST_SORT_ADD_WORDS(constant_level)                                                     \
    for (uint i = 0; i < length; ++i)                                                              \
        words[i] = (ulong)cellist_sort_without_word(keys[i]) << 32 |                               \
                   cellist_sort_word(cellist_sort_at(i), constant_level);
    switch (level) {
        case 0:
            CELLIST_SORT_ADD_WORDS(0)
            break;
        case 1:
            CELLIST_SORT_ADD_WORDS(1)
            break;
        default:
            CELLIST_SORT_ADD_WORDS(level)
    }
#undef CELLIST_SORT_ADD_WORDS
}

// Writes the order where keys may be equal. Equal records stay in theirs. Keys have words where
// there is room. Overwrites the ranks, and takes note of the level.
static void cellist_sort_order_equal(global const cellist_sort_node* nodes, uint first,
                                     const uint* index, const cellist_sort_bits* keys, uint length,
                                     uint member, cellist_sort_ties* ties, uint* ranks,
                                     uchar* order) {
    ulong words[CELLIST_SORT_CHUNK_SIZE];
    // The second time, the level is the first at which ties differ.
    for (uint attempt = 0; attempt < 2; ++attempt) {
        const uint assumed = ties->tie_level;
        uint level = assumed;
        if (cellist_sort_key_bytes() <= 4)
            cellist_sort_add_words(nodes, first, index, keys, length, level++, words);
        else
            for (uint i = 0; i < length; ++i) words[i] = keys[i];
        const int one_word_decides = cellist_sort_rank_wide(words, length, ranks);
        int unique = one_word_decides;
        if (!unique) {
            for (uint i = 0; i < length; ++i)
                words[i] = (ulong)ranks[i] << 56 |
                           (ulong)cellist_sort_word(cellist_sort_at(i), level) << 24 |
                           cellist_sort_word(cellist_sort_at(i), level + 1) >> 8;
            unique = cellist_sort_rank_wide(words, length, ranks);
        }
        if (unique)
            cellist_sort_order(ranks, length, member, order);
        else
            cellist_sort_merge_equal(nodes, first, index, ranks, length, order);

        const uint most = one_word_decides ? assumed : CELLIST_SORT_LEVELS;
        const uint difference =
            cellist_sort_first_difference(nodes, first, index, keys, length, order, most);
        if (difference < CELLIST_SORT_LEVELS) ties->tie_level = difference;
        if (difference >= assumed) return;
    }
}

#endif
