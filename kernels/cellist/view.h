// SPDX-License-Identifier: MIT
// What the host and the device must agree on about a container. Compiled as C++ and as OpenCL C.
#ifndef CELLIST_VIEW_H
#define CELLIST_VIEW_H

#ifdef __OPENCL_VERSION__
#define CELLIST_UINT uint
#else
#define CELLIST_UINT cl_uint
#endif

// A counter gives this many nodes before the addresses move on by a whole round of shards. A block
// of 256 keeps the stores of a work-group together.
#define CELLIST_BLOCK_BITS 8u
#define CELLIST_BLOCK_NODES (1u << CELLIST_BLOCK_BITS)

// Shards at most. More do not help on any device measured; fewer bring back contention.
#define CELLIST_SHARD_BITS_MAX 8u

// No node, no cell. Also the end of a list.
#define CELLIST_NONE 0xFFFFFFFFu

// Largest capacity. It leaves room between the capacity and 2^32 for what the work-items that
// allocate at one moment ask for, CELLIST_BLOCK_NODES each at most: a counter runs past its last
// node by as many, and comes back.
#define CELLIST_CAPACITY_NODES_MAX 0xC0000000u

// Words from one counter of a region to the next: a counter is alone in its sector of 32 bytes.
#define CELLIST_REGION_COUNT_WORDS 8u
// Work-items that move the records of a region to their lists.
#define CELLIST_REGION_GROUP 512
// Work-items that divide the memory into regions.
#define CELLIST_REGION_SCAN_GROUP 1024

// Consecutive records that an append moves together, and the work-items of GPUs that share them.
#define CELLIST_MOVE_TILE 512u
#define CELLIST_MOVE_LANES 64u

// Inserts that are counted for one cell; more of them are counted as dropped.
#define CELLIST_CELL_COUNT_MAX 0x80000000u

// Largest extent of one dimension: coordinates are compared as 32-bit integers.
#define CELLIST_EXTENT_MAX 0x7FFFFFFFu

// How the nodes are arranged, and what an insert does. The host compiles a program for the modes of
// its containers only.
#define CELLIST_LINKED 1u
#define CELLIST_COUNTING 2u
#define CELLIST_CONTIGUOUS 4u
#define CELLIST_FIXED 8u
#define CELLIST_THRESHOLD_PASS 16u
#define CELLIST_SELECTION_PASS 32u
#define CELLIST_PARTITIONED 64u
// Not a mode of nodes: a container of the program is distributed over ranks. See distributed.clh.
#define CELLIST_DISTRIBUTED_MODE 128u

// Every storage: ROW(name, its modes, a, b), where a and b are passed on. <name>.clh describes the
// heads and nodes of the modes; storage_<name>.cpp is the host's part.
#define CELLIST_STORAGES(ROW, a, b)                                                                \
    ROW(linked, CELLIST_LINKED, a, b)                                                              \
    ROW(counted, CELLIST_COUNTING | CELLIST_CONTIGUOUS | CELLIST_PARTITIONED, a, b)                \
    ROW(fixed, CELLIST_FIXED, a, b)                                                                \
    ROW(nearest, CELLIST_THRESHOLD_PASS | CELLIST_SELECTION_PASS, a, b)

#ifdef __OPENCL_VERSION__
// Whether a container has one of these modes. Known at compile time unless the program's containers
// differ: the host defines CELLIST_MODES, the set of their modes.
#define cellist_has_mode(view, modes)                                                              \
    (!(CELLIST_MODES & ~(modes)) || ((CELLIST_MODES & (modes)) && ((view).mode & (modes))))

#define CELLIST_OVERLOAD __attribute__((overloadable))
#endif

// Rows of the heads in nearest.clh.
#define CELLIST_ROW_REMAINING 1u
#define CELLIST_ROW_EQUALS 2u
#define CELLIST_ROW_LEAST 3u

// Passed to kernels by value.
typedef struct cellist_view {
    CELLIST_UINT extent[4];   // cells along x, y, z, w; missing dimensions are 1
    CELLIST_UINT cells;       // product of the extents
    CELLIST_UINT pool_nodes;  // nodes in the pool, those of per-thread blocks included
    CELLIST_UINT shard_bits;  // the counters have 2^shard_bits shards
    CELLIST_UINT mode;        // one of the modes above
    CELLIST_UINT slots;       // nodes of each cell in fixed.clh and nearest.clh
    CELLIST_UINT first_cell;  // of the cells that have lists now: 0 but in a build in slices
    CELLIST_UINT open_cells;  // cells from the first on that take inserts: 0 outside of a build
    CELLIST_UINT key_member;  // of the record: the key of nearest.clh
    CELLIST_UINT threshold_words;  // words of the key that have thresholds
    CELLIST_UINT thread_slots;     // 0, or a power of two from 8 on
    CELLIST_UINT partition_bits;   // cells of a partition in mode PARTITIONED: 2^partition_bits
    CELLIST_UINT periodic_axes;    // bit i: axis i wraps around
} cellist_view;

// What kernels may insert into a distributed container: records of the rank's own block, which go
// into its lists, and those of other ranks, which go into its outbox.
#define CELLIST_INSERT_OWN 1u
#define CELLIST_INSERT_FOREIGN 2u

// How the cells of a distributed container are divided, as one rank sees it. Passed by value.
typedef struct cellist_distribution {
    cellist_view domain;          // the extents, the cells and the periodic axes of the whole shape
    cellist_view outbox;          // the outbox as a pool of nodes
    CELLIST_UINT origin[4];       // of the rank's block in the domain
    CELLIST_UINT block[4];        // extents of the block; 0 if it is empty
    CELLIST_UINT ghosts[4];       // layers of ghost cells on either side of the block
    CELLIST_UINT held[4];         // extents of the rank's lists: block and ghosts
    CELLIST_UINT stride[3];       // cells of the domain in a row, a plane and a volume
    CELLIST_UINT inverse[3];      // of these, in units of 2^-32
    CELLIST_UINT held_stride[3];  // cells of the rank's lists in a row, a plane and a volume
    CELLIST_UINT own_offset;      // from a cell's position times the strides to its index
    CELLIST_UINT range_first;     // the cells of a block that is a range of them ...
    CELLIST_UINT range_cells;     // ... CELLIST_NONE for other blocks; own_offset is then from the
                                  // cell to its index
    CELLIST_UINT inserts;         // CELLIST_INSERT_...; 0 outside of a build
} cellist_distribution;

// The counters of one shard, alone in its cache line. The struct after the last shard holds the
// pool's state.
typedef struct cellist_shard {
    CELLIST_UINT allocated;    // nodes handed out
    CELLIST_UINT dropped_low;  // inserts that found no free node, 64 bits in two words
    CELLIST_UINT dropped_high;
    CELLIST_UINT rejected_low;  // inserts into cells outside the shape, 64 bits in two words
    CELLIST_UINT rejected_high;
    CELLIST_UINT pool_full;  // only after the last shard: not 0 once every shard was seen full
    CELLIST_UINT late_low;   // only after the last shard: inserts outside a build, in two words
    CELLIST_UINT late_high;
    CELLIST_UINT full_shards;  // this shard and the next ones, up to this number, were seen full
    CELLIST_UINT padding[7];
} cellist_shard;

// Nodes that one thread has for itself, alone in its cache line: those at the addresses node ...
// last - 1, which lie in one block, and then the next ... end - 1 of a shard.
typedef struct cellist_thread_block {
    CELLIST_UINT node;
    CELLIST_UINT last;
    CELLIST_UINT shard;
    CELLIST_UINT next;
    CELLIST_UINT end;
    CELLIST_UINT padding[11];
} cellist_thread_block;

// Where a thread keeps the records of one partition: in blocks of CELLIST_BLOCK_NODES nodes. All
// blocks but the last are full.
typedef struct cellist_cursor {
    CELLIST_UINT node;    // the next one
    CELLIST_UINT last;    // the end of its block
    CELLIST_UINT block;   // the last; the chain leads to those before
    CELLIST_UINT blocks;  // how many
} cellist_cursor;

// What the check after a selection pass finds, from 0.
typedef struct cellist_selection {
    CELLIST_UINT undecided;   // cells with more records at the thresholds than slots for them
    CELLIST_UINT words;       // of a record's key
    CELLIST_UINT unrepeated;  // cells with other records than the threshold passes saw
} cellist_selection;

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

// Counts nodes, alone in its cache line. Work-groups spread their atomics over several counters: on
// an H200, a short sort takes up to 13 % less time than with one.
#define CELLIST_SORT_COUNTERS 16u
typedef struct cellist_sort_counter {
    CELLIST_UINT nodes;
    CELLIST_UINT padding[15];
} cellist_sort_counter;

// What the first lists of a sort tell about equal keys in the others.
typedef struct cellist_sort_ties {
    CELLIST_UINT ranked_lists;  // by their keys alone
    CELLIST_UINT tied_lists;    // those of them that have equal keys
    CELLIST_UINT tie_level;     // words of the records that are the same in all ties
} cellist_sort_ties;

// What the kernels that sort find, from 0.
typedef struct cellist_sort_state {
    CELLIST_UINT nodes;                           // of the lists that were sorted, and moved
    CELLIST_UINT chunks;                          // of all long lists
    CELLIST_UINT longest;                         // nodes of a long list
    CELLIST_UINT broken;                          // lists with links that no build makes
    CELLIST_UINT longer[CELLIST_SORT_STAGES];     // lists that were left by each class
    CELLIST_UINT in_class[CELLIST_SORT_CLASSES];  // lists that were sorted in work-groups
    cellist_sort_ties ties;
    cellist_sort_counter in_place[CELLIST_SORT_COUNTERS];  // of the other lists that were sorted
} cellist_sort_state;

// Where a long list is sorted.
typedef struct cellist_sort_long_list {
    CELLIST_UINT length;  // 0 if its links are broken
    CELLIST_UINT first;   // node
    CELLIST_UINT chunk;   // its first
} cellist_sort_long_list;

#endif
