// What the kernels that sort have in common: the order of records, and ranking the keys of a few of
// them.
//
// The order is that of cellist_sort_key(record), then that of the record's scalars. The host defines
// cellist_sort_key, which maps the key to an unsigned integer of the same order, and before it:
//
//   CELLIST_SORT_KEY_BITS   32 or 64, what the key needs
//   CELLIST_SORT_ITEMS      work-items that sort together, a power of two. More than one are a
//                           work-group and share local memory (GPUs); one needs neither (CPUs)
//   CELLIST_SORT_WIDTH      records that a work-item ranks at once: 4, 8 or 16
//   CELLIST_SORT_SLOTS      most records that are ranked together; at least the width, at most 256
//
// A record's rank is the number of records that come before it. Ranking compares each with each: for
// some hundred records this is faster than any sort that branches, since it is the same work for all
// of them, and it reads one key for CELLIST_SORT_WIDTH comparisons.
#include <cellist/lists.clh>

#define CELLIST_SORT_PASTE(type, width) type##width
#define CELLIST_SORT_VECTOR(type, width) CELLIST_SORT_PASTE(type, width)
#if CELLIST_SORT_KEY_BITS == 32
typedef uint cellist_sort_bits;
typedef CELLIST_SORT_VECTOR(uint, CELLIST_SORT_WIDTH) cellist_sort_keys;
typedef int cellist_sort_count;
typedef CELLIST_SORT_VECTOR(int, CELLIST_SORT_WIDTH) cellist_sort_counts;
#else
typedef ulong cellist_sort_bits;
typedef CELLIST_SORT_VECTOR(ulong, CELLIST_SORT_WIDTH) cellist_sort_keys;
typedef long cellist_sort_count;
typedef CELLIST_SORT_VECTOR(long, CELLIST_SORT_WIDTH) cellist_sort_counts;
#endif

#if CELLIST_SORT_ITEMS > 1
#define CELLIST_SORT_KERNEL                                                                        \
    kernel __attribute__((reqd_work_group_size(CELLIST_SORT_ITEMS, 1, 1))) void
#define CELLIST_SORT_SHARED local
#define cellist_sort_item() ((uint)get_local_id(0))
#define cellist_sort_barrier() barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
#define cellist_sort_add(sum, value) atomic_add(sum, value)
// Keys of one list behind those of another: neighbouring lists begin in different banks.
#define CELLIST_SORT_STRIDE (CELLIST_SORT_SLOTS + 1)
#else
#define CELLIST_SORT_KERNEL kernel void
#define CELLIST_SORT_SHARED
#define cellist_sort_item() 0u
#define cellist_sort_barrier()
#define cellist_sort_add(sum, value) (*(sum) += (value))
#define CELLIST_SORT_STRIDE CELLIST_SORT_SLOTS
#endif

// Nodes of a list in one piece; none where the offsets are impossible.
static inline uint cellist_sort_length(volatile global uint* heads, const cellist_view view,
                                       uint cell) {
    const uint begin = cellist_begin(heads, view, cell);
    const uint end = cellist_end(heads, view, cell);
    return begin <= end && end <= view.capacity_nodes ? end - begin : 0;
}

// The records that are ranked together: the nodes of a list, or those behind a first node.
static inline uint cellist_sort_node(CELLIST_SORT_SHARED const uint* nodes, uint first, uint i) {
    return CELLIST_MODES == CELLIST_LINKED ? nodes[i] : first + i;
}

// Finds the places of the records from `at` on, CELLIST_SORT_WIDTH of them, among `length` records by
// their keys alone: order[place] is a record's number. Returns the sum of the places. All of them
// together give length * (length - 1) / 2, or less if keys are equal; cellist_sort_rank_equal is right
// then, too.
static inline uint cellist_sort_rank(CELLIST_SORT_SHARED const cellist_sort_bits* keys, uint length,
                                     uint at, CELLIST_SORT_SHARED uchar* order) {
    const cellist_sort_keys own = CELLIST_SORT_VECTOR(vload, CELLIST_SORT_WIDTH)(0, keys + at);
    cellist_sort_counts before = 0;
    // A comparison that holds is -1.
    for (uint i = 0; i < length; ++i) before -= (cellist_sort_keys)keys[i] < own;
    cellist_sort_count places[CELLIST_SORT_WIDTH];
    CELLIST_SORT_VECTOR(vstore, CELLIST_SORT_WIDTH)(before, 0, places);
    uint sum = 0;
    for (uint i = 0; i < CELLIST_SORT_WIDTH && at + i < length; ++i) {
        order[places[i]] = (uchar)(at + i);
        sum += (uint)places[i];
    }
    return sum;
}

// The same, with records of equal keys in the order of the records. Equal records stay in their order.
static void cellist_sort_rank_equal(CELLIST_LISTS(CELLIST_RECORD, lists),
                                    CELLIST_SORT_SHARED const cellist_sort_bits* keys,
                                    CELLIST_SORT_SHARED const uint* nodes, uint first, uint length,
                                    uint at, CELLIST_SORT_SHARED uchar* order) {
    for (uint i = at; i < at + CELLIST_SORT_WIDTH && i < length; ++i) {
        const CELLIST_RECORD own = cellist_get(lists, cellist_sort_node(nodes, first, i));
        uint place = 0;
        for (uint j = 0; j < length; ++j) {
            place += keys[j] < keys[i];
            if (keys[j] != keys[i] || j == i) continue;
            const CELLIST_RECORD other = cellist_get(lists, cellist_sort_node(nodes, first, j));
            place += cellist_record_before(other, own, 0) ||
                     (j < i && !cellist_record_before(own, other, 0));
        }
        order[place] = (uchar)i;
    }
}
