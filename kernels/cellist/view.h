// What the host and the device must agree on about a container. Compiled as C++ and as OpenCL C.
#ifndef CELLIST_VIEW_H
#define CELLIST_VIEW_H

#ifdef __OPENCL_VERSION__
#define CELLIST_UINT uint
#else
#define CELLIST_UINT cl_uint
#endif

// Nodes that are handed out from one counter before the addresses move on by a whole round of
// shards. A block of 256 keeps the stores of a work-group together.
#define CELLIST_BLOCK_BITS 8u
#define CELLIST_BLOCK_NODES (1u << CELLIST_BLOCK_BITS)

// Shards at most. More do not help on any device measured; fewer bring back contention.
#define CELLIST_SHARD_BITS_MAX 8u

// No node, no cell. Also the end of a list.
#define CELLIST_NONE 0xFFFFFFFFu

// Largest capacity. It leaves room between the capacity and 2^32 for what the work-items that are
// inside an allocation at one moment ask for, CELLIST_BLOCK_NODES each at most: a counter runs past its
// last node by as many, and comes back.
#define CELLIST_CAPACITY_NODES_MAX 0xC0000000u

// Inserts that are counted for one cell; more of them are counted as dropped.
#define CELLIST_CELL_COUNT_MAX 0x80000000u

// Largest extent of one dimension: coordinates are compared as 32-bit integers.
#define CELLIST_EXTENT_MAX 0x7FFFFFFFu

// How the nodes are arranged, and what an insert does. A program is compiled for the modes of its
// containers only.
//
//   mode        heads                                       node
//   LINKED      cells: the first node, or CELLIST_NONE      record and link
//   COUNTING    counts behind the offsets, as below         none: inserts only count
//   CONTIGUOUS  cells + 1 offsets, then cells counts        record
//   FIXED       cells: the inserts so far                   record
//   RANKING     as below                                    none: inserts only rank their keys
//   CHOOSING    the same                                    record, as in FIXED
//   PARTITIONED as below                                    record, and its cell where the link is
//
// RANKING and CHOOSING find the K = slots records of each cell that come first. Their heads are rows
// of `cells` words:
//   counts     1   the records in the slots
//   wanted     1   how many of the records that equal the thresholds are kept
//   equals     1   how many of them there are
//   least      K   the K least words of RANKING, ascending
//   thresholds     one for each word of the key that was ranked
//
// PARTITIONED is the one pass of CONTIGUOUS on processors whose threads have nodes of their own (threads.clh).
// Its nodes and heads are not those of the lists: partitions.cl moves the records there. A partition is
// 2^partition_bits cells. Heads:
//   owners     2 hands             threads, in two words each
//   cursors    hands * partitions  cellist_cursor
//   chain      blocks of nodes     the block that the same cursor had before
#define CELLIST_LINKED 1u
#define CELLIST_COUNTING 2u
#define CELLIST_CONTIGUOUS 4u
#define CELLIST_FIXED 8u
#define CELLIST_RANKING 16u
#define CELLIST_CHOOSING 32u
#define CELLIST_PARTITIONED 64u

// Rows of the heads in modes RANKING and CHOOSING.
#define CELLIST_ROW_WANTED 1u
#define CELLIST_ROW_EQUALS 2u
#define CELLIST_ROW_LEAST 3u

// Passed to kernels by value.
typedef struct cellist_view {
    CELLIST_UINT extent[4];       // cells along x, y, z, w; missing dimensions are 1
    CELLIST_UINT cells;           // product of the extents
    CELLIST_UINT capacity_nodes;  // nodes in the pool, those for hands of threads included
    CELLIST_UINT shard_bits;      // the counters have 2^shard_bits shards
    CELLIST_UINT mode;            // one of the modes above
    CELLIST_UINT slots;           // nodes of each cell in mode FIXED
    CELLIST_UINT first_cell;      // of the cells that have lists now: 0 but in a build in slices
    CELLIST_UINT open_cells;      // cells from the first on that take inserts: 0 outside of a build
    CELLIST_UINT rank_member;     // of the record, that it is ranked by
    CELLIST_UINT rank_words;      // words of the key that have thresholds
    CELLIST_UINT hands;           // of threads: 0, or a power of two from 8 on
    CELLIST_UINT partition_bits;  // cells of a partition in mode PARTITIONED: 2^partition_bits
} cellist_view;

// The counters of one shard, alone in its cache line. The struct behind the last shard holds the
// pool's state.
typedef struct cellist_shard {
    CELLIST_UINT allocated;    // nodes handed out
    CELLIST_UINT dropped_low;  // inserts that found no free node, 64 bits in two words
    CELLIST_UINT dropped_high;
    CELLIST_UINT rejected_low;  // inserts into cells outside the shape, 64 bits in two words
    CELLIST_UINT rejected_high;
    CELLIST_UINT pool_full;  // behind the last shard: not 0 once every shard was seen full
    CELLIST_UINT late_low;   // only after the last shard: inserts outside a build, in two words
    CELLIST_UINT late_high;
    CELLIST_UINT passed;  // when this shard was full, so many were seen full from it on
    CELLIST_UINT padding[7];
} cellist_shard;

// Nodes that a thread has for itself, alone in its cache line: those at the addresses node ... last - 1,
// which lie in one block, and then the next ... end - 1 of a shard.
typedef struct cellist_hand {
    CELLIST_UINT node;
    CELLIST_UINT last;
    CELLIST_UINT shard;
    CELLIST_UINT next;
    CELLIST_UINT end;
    CELLIST_UINT padding[11];
} cellist_hand;

// Where a thread keeps the records of one partition: in blocks of CELLIST_BLOCK_NODES nodes, all but the
// last of which are full.
typedef struct cellist_cursor {
    CELLIST_UINT node;    // the next one
    CELLIST_UINT last;    // the end of its block
    CELLIST_UINT block;   // the last; the chain leads to those before
    CELLIST_UINT blocks;  // how many
} cellist_cursor;

// What a choice among the records of each cell finds, from 0.
typedef struct cellist_choice {
    CELLIST_UINT undecided;   // cells with more records at the thresholds than slots for them
    CELLIST_UINT words;       // of a record's key
    CELLIST_UINT unrepeated;  // cells with other records than those that were ranked
} cellist_choice;

// What a validation finds, from 0; each of its kernels says which of these it counts.
typedef struct cellist_findings {
    CELLIST_UINT broken;
    CELLIST_UINT repeated;
    CELLIST_UINT unfilled;
    CELLIST_UINT nodes;
    CELLIST_UINT bad_cell_from_end;  // CELLIST_NONE less the lowest cell that is bad, or 0
} cellist_findings;

// Classes of lists by their length: up to 16, 32, 64, 128, 256 nodes, and more.
#define CELLIST_SORT_CLASS_MIN 16u
#define CELLIST_SORT_CLASSES 6u
// A sort looks at every other class at most.
#define CELLIST_SORT_STAGES ((CELLIST_SORT_CLASSES + 1u) / 2u)

// What the kernels that sort find, from 0.
typedef struct cellist_sort_state {
    CELLIST_UINT nodes;                           // that have their places, of linked lists
    CELLIST_UINT chunks;                          // of all long lists
    CELLIST_UINT longest;                         // nodes of a long list
    CELLIST_UINT broken;                          // lists with links that no build makes
    CELLIST_UINT longer[CELLIST_SORT_STAGES];     // lists that were left by each class
    CELLIST_UINT in_class[CELLIST_SORT_CLASSES];  // lists that were sorted in work-groups
} cellist_sort_state;

// Where a long list is sorted.
typedef struct cellist_sort_long {
    CELLIST_UINT length;  // 0 if its links are broken
    CELLIST_UINT first;   // node
    CELLIST_UINT chunk;   // its first
} cellist_sort_long;

#endif
