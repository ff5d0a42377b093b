// SPDX-License-Identifier: MIT
// What the kernels that sort have in common: how nodes lie in memory, and ranking a few of them.
//
// The order is that of cellist_sort_key, then that of the record's scalars. The host defines
//
//   CELLIST_SORT_KEY_BITS      32 or 64, what the key needs
//   CELLIST_SORT_KEEPS_KEYS    1 if a merge reads stored keys, 0 if it computes them again
//   CELLIST_SORT_CHUNK_SIZE    records that are ranked together, a power of two up to 256
//   CELLIST_SORT_WIDTH         records that a work-item ranks at once: 4 or 8
//   CELLIST_SORT_ITEMS         work-items that sort together, a power of two. More than one are a
//                              work-group and share local memory (GPUs); one needs neither (CPUs)
//   CELLIST_SORT_TEAM          work-items that sort a list, a power of two
//   CELLIST_SORT_LISTS         lists that CELLIST_SORT_ITEMS work-items sort, or segments of lists
//                              that a work-item traverses
//   CELLIST_SORT_MERGE_ITEMS   nodes that a work-item merges, a power of two
//   CELLIST_SORT_TOP_K         the largest k of a partial sort, up to 64
//   CELLIST_SORT_SEGMENT_BITS  2^CELLIST_SORT_SEGMENT_BITS nodes of the pool have one splitter
//   CELLIST_SORT_PIECE         the type of the pieces in which large nodes move; not defined if
//                              nodes move whole
//
//   cellist_values             a struct of the values that the expression of the key uses
//   cellist_sort_key(pointer to a record, values)
//                              maps the key to an unsigned integer of the same order
//   cellist_sort_key_bytes()   the size of the key's type: a key of up to 4 bytes has 32 bits
//   cellist_sort_word(pointer to a record, i)
//                              the i-th of the 32-bit words that decide between equal keys, in the
//                              order of the members; 0 after the last word
//
// If the user's expression is not an order, its value may differ from call to call. No record is
// lost then: the code that moves records compares each pair once, or reads stored keys.
//
// The rank of a record is the number of records that come before it. Ranking compares all with all:
// for up to some hundred records this is faster than sorts with fewer comparisons, because it does
// not branch on what it finds, and reads one key for CELLIST_SORT_WIDTH comparisons.
#include <cellist/lists.clh>

#define CELLIST_SORT_PASTED(a, b) a##b
#define CELLIST_SORT_PASTE(a, b) CELLIST_SORT_PASTED(a, b)
#if CELLIST_SORT_KEY_BITS == 32
typedef uint cellist_sort_bits;
#define CELLIST_SORT_VECTOR_OF_BITS uint
#define CELLIST_SORT_VECTOR_OF_COUNTS int
#else
typedef ulong cellist_sort_bits;
#define CELLIST_SORT_VECTOR_OF_BITS ulong
#define CELLIST_SORT_VECTOR_OF_COUNTS long
#endif

#if CELLIST_SORT_ITEMS > 1
#define CELLIST_SORT_KERNEL                                                                        \
    kernel __attribute__((reqd_work_group_size(CELLIST_SORT_ITEMS, 1, 1))) void
#define CELLIST_SORT_SHARED local
#define cellist_sort_item() ((uint)get_local_id(0))
#define cellist_sort_barrier() barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
// On GPUs, private arrays stay in registers only if loops are unrolled, which needs a constant
// number of steps. On CPUs, such loops take much longer to compile and to run. `condition` stays
// false once it is false: CPUs stop there.
#define cellist_sort_each(i, most, condition)                                                      \
    _Pragma("unroll") for (uint i = 0; i < (most); ++i) if (!(condition)) {}                       \
    else
// Neighbouring lists begin in different banks of local memory.
#define CELLIST_SORT_STRIDE (CELLIST_SORT_CHUNK_SIZE + 1)
static inline uint cellist_sort_add(local uint* sum, uint value) { return atomic_add(sum, value); }
#else
#define CELLIST_SORT_KERNEL kernel void
#define CELLIST_SORT_SHARED
#define cellist_sort_item() 0u
#define cellist_sort_barrier()
#define cellist_sort_each(i, most, condition) for (uint i = 0; i < (most) && (condition); ++i)
#define CELLIST_SORT_STRIDE CELLIST_SORT_CHUNK_SIZE
static inline uint cellist_sort_add(uint* sum, uint value) {
    *sum += value;
    return *sum - value;
}
#endif

// Counts the nodes of lists that were sorted in place.
static inline void cellist_sort_count_nodes(volatile global cellist_sort_state* state, uint nodes) {
    atomic_add(&state->in_place[get_group_id(0) % CELLIST_SORT_COUNTERS].nodes, nodes);
}

// A node as it lies in a pool.
typedef struct cellist_sort_node {
#if CELLIST_MODES == CELLIST_LINKED
    CELLIST_SORT_PASTE(cellist_node_, CELLIST_RECORD) stored;
} cellist_sort_node;
#define cellist_sort_record(node) ((node).stored.record)
#else
    CELLIST_RECORD_TYPE stored;
} cellist_sort_node;
#define cellist_sort_record(node) ((node).stored)
#endif

// What moves at once: a node, or a part of a large one.
#ifdef CELLIST_SORT_PIECE
#ifdef __clang__
typedef CELLIST_SORT_PIECE __attribute__((may_alias)) cellist_sort_piece;
#else
typedef CELLIST_SORT_PIECE cellist_sort_piece;
#endif
#else
typedef cellist_sort_node cellist_sort_piece;
#endif
#define CELLIST_SORT_PIECES (sizeof(cellist_sort_node) / sizeof(cellist_sort_piece))

// The link of the node at `at` in a contiguous list; `last` is the address of the last node.
static inline uint cellist_sort_link(uint at, uint last) {
    return at < last ? at + 1 : CELLIST_NONE;
}

// Copies a node to its place in a contiguous list.
static inline void cellist_sort_store(global cellist_sort_node* nodes, uint at, uint last,
                                      global const cellist_sort_node* node) {
#if CELLIST_MODES != CELLIST_LINKED
    nodes[at] = *node;
#elif defined(CELLIST_SORT_PIECE)
    nodes[at] = *node;
    nodes[at].stored.next = cellist_sort_link(at, last);
#else
        cellist_sort_node moved = *node;
        moved.stored.next = cellist_sort_link(at, last);
        nodes[at] = moved;
#endif
}

#if CELLIST_MODES != CELLIST_LINKED
// Whether the offsets of a list are impossible. Cells of another slice have no records, whatever
// their offsets.
static inline int cellist_sort_is_broken(volatile global uint* heads, const cellist_view view,
                                         uint cell) {
    const uint begin = cellist_begin(heads, view, cell);
    const uint end = cellist_end(heads, view, cell);
    return begin != end && (begin > end || end > view.pool_nodes);
}

// Nodes of a list; none where the offsets are impossible.
static inline uint cellist_sort_length(volatile global uint* heads, const cellist_view view,
                                       uint cell) {
    if (cellist_sort_is_broken(heads, view, cell)) return 0;
    return cellist_end(heads, view, cell) - cellist_begin(heads, view, cell);
}
#endif

// Leaves a list to another class. Sound lists that are longer than a class are no more than
// `longer` has room for.
static inline void cellist_sort_leave(global uint* longer, uint longer_end, uint stage, uint cell,
                                      volatile global cellist_sort_state* state) {
    const uint at = atomic_inc(&state->longer[stage]);
    if (at < longer_end)
        longer[at] = cell;
    else
        atomic_inc(&state->broken);
}

// Whether record a, with key x, comes before record b, with key y.
static inline uint cellist_sort_before(global const CELLIST_RECORD_TYPE* a, cellist_sort_bits x,
                                       global const CELLIST_RECORD_TYPE* b, cellist_sort_bits y) {
    return x != y ? x < y : cellist_record_before(a, b, 0);
}

// For each of CELLIST_SORT_WIDTH keys, from the one `at` on, how many of `length` keys are less.
static inline void cellist_sort_count(CELLIST_SORT_SHARED const cellist_sort_bits* keys,
                                      uint length, uint at, uint* ranks) {
#if CELLIST_SORT_ITEMS > 1
    cellist_sort_bits own[CELLIST_SORT_WIDTH];
    for (uint j = 0; j < CELLIST_SORT_WIDTH; ++j) {
        own[j] = keys[at + j];
        ranks[j] = 0;
    }
    for (uint i = 0; i < length; ++i)
        for (uint j = 0; j < CELLIST_SORT_WIDTH; ++j) ranks[j] += keys[i] < own[j];
#else
    typedef CELLIST_SORT_PASTE(CELLIST_SORT_VECTOR_OF_BITS, CELLIST_SORT_WIDTH) vector_of_bits;
    typedef CELLIST_SORT_PASTE(CELLIST_SORT_VECTOR_OF_COUNTS, CELLIST_SORT_WIDTH) vector_of_counts;
    const vector_of_bits own = CELLIST_SORT_PASTE(vload, CELLIST_SORT_WIDTH)(0, keys + at);
    vector_of_counts before = 0;
    // A comparison of vectors that holds is -1.
    for (uint i = 0; i < length; ++i) before -= (vector_of_bits)keys[i] < own;
    CELLIST_SORT_PASTE(vstore, CELLIST_SORT_WIDTH)
    (CELLIST_SORT_PASTE(convert_uint, CELLIST_SORT_WIDTH)(before), 0, ranks);
#endif
}

// What one of CELLIST_SORT_TEAM work-items does to rank the records of a list: it has every
// CELLIST_SORT_TEAM-th run of CELLIST_SORT_WIDTH records.
#define CELLIST_SORT_RUNS (CELLIST_SORT_CHUNK_SIZE / (CELLIST_SORT_TEAM * CELLIST_SORT_WIDTH))
#define cellist_sort_each_run(n, at, member, length)                                               \
    for (uint n = 0, at = (member)*CELLIST_SORT_WIDTH; n < CELLIST_SORT_RUNS && at < (length);     \
         ++n, at += CELLIST_SORT_TEAM * CELLIST_SORT_WIDTH)

// Finds the ranks of a work-item's records by their keys, and returns the sum of these ranks. The
// sums over all records add up to length * (length - 1) / 2, or to less if keys are equal.
static inline uint cellist_sort_rank(CELLIST_SORT_SHARED const cellist_sort_bits* keys, uint length,
                                     uint member, uint* ranks) {
    uint sum = 0;
    cellist_sort_each_run(n, at, member, length) {
        cellist_sort_count(keys, length, at, ranks + n * CELLIST_SORT_WIDTH);
        cellist_sort_each(i, CELLIST_SORT_WIDTH, at + i < length) {
            sum += ranks[n * CELLIST_SORT_WIDTH + i];
        }
    }
    return sum;
}

// Whether no two keys are equal.
static inline int cellist_sort_unique(uint sum, uint length) {
    return sum == length * (length - 1u) / 2u;
}

// Writes what cellist_sort_rank has found: order[rank] is the record.
static inline void cellist_sort_order(const uint* ranks, uint length, uint member,
                                      CELLIST_SORT_SHARED uchar* order) {
    cellist_sort_each_run(n, at, member, length) {
        cellist_sort_each(i, CELLIST_SORT_WIDTH, at + i < length) {
            order[ranks[n * CELLIST_SORT_WIDTH + i]] = (uchar)(at + i);
        }
    }
}

// Most nodes of a list that one work-item moves.
#define CELLIST_SORT_MOVED (CELLIST_SORT_CHUNK_SIZE / CELLIST_SORT_TEAM)

// Moves the `length` nodes from `first` on into the order that was found, piece by piece. All
// work-items of the group call it.
static inline void cellist_sort_permute(global cellist_sort_node* nodes, uint first, uint last,
                                        uint length, uint member,
                                        CELLIST_SORT_SHARED const uchar* order) {
    global cellist_sort_piece* pieces = (global cellist_sort_piece*)(nodes + first);
    cellist_sort_piece moved[CELLIST_SORT_MOVED];
    for (uint piece = 0; piece < CELLIST_SORT_PIECES; ++piece) {
        cellist_sort_each(i, CELLIST_SORT_MOVED, member + i * CELLIST_SORT_TEAM < length) {
            const uint from = order[member + i * CELLIST_SORT_TEAM];
            moved[i] = pieces[(ulong)from * CELLIST_SORT_PIECES + piece];
        }
        cellist_sort_barrier();
        cellist_sort_each(i, CELLIST_SORT_MOVED, member + i * CELLIST_SORT_TEAM < length) {
            const uint at = member + i * CELLIST_SORT_TEAM;
#if CELLIST_MODES == CELLIST_LINKED && !defined(CELLIST_SORT_PIECE)
            moved[i].stored.next = cellist_sort_link(first + at, last);
#endif
            pieces[(ulong)at * CELLIST_SORT_PIECES + piece] = moved[i];
        }
    }
#if CELLIST_MODES == CELLIST_LINKED && defined(CELLIST_SORT_PIECE)
    for (uint at = member; at < length; at += CELLIST_SORT_TEAM)
        nodes[first + at].stored.next = cellist_sort_link(first + at, last);
#endif
}
