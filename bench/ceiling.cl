// SPDX-License-Identifier: MIT
// The hardware's limits for an insert. The work-item's index is the address, so there is no
// allocation, but in allocate_exchange_and_store. A node is stored at once. Every kernel checks its
// range, as an insert does.
//
//   heads     cells     the index of the last node of each cell
//   nodes     count     the words of a record, then the link
//   counters  256 * 16  nodes of each counter; a counter alone in its cache line

#if BENCH_WORDS == 1
typedef uint2 bench_node;
#define BENCH_NODE(i, next) (uint2)(bench_word(i, 0), next)
#elif BENCH_WORDS == 3
typedef uint4 bench_node;
#define BENCH_NODE(i, next) (uint4)(bench_word(i, 0), bench_word(i, 1), bench_word(i, 2), next)
#elif BENCH_WORDS == 7
typedef uint8 bench_node;
#define BENCH_NODE(i, next)                                                                        \
    (uint8)(bench_word(i, 0), bench_word(i, 1), bench_word(i, 2), bench_word(i, 3),                \
            bench_word(i, 4), bench_word(i, 5), bench_word(i, 6), next)
#endif

kernel void copy(global const bench_node* from, global bench_node* to, uint count) {
    const uint i = get_global_id(0);
    if (i < count) to[i] = from[i];
}

kernel void store(global bench_node* nodes, uint cells, uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i < count) nodes[i] = BENCH_NODE(i, bench_cell(i, cells, distribution));
}

kernel void exchange(volatile global uint* heads, uint cells, uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    // No head holds the index of this work-item yet. Compilers do not know this, so the exchange
    // must return the old value.
    const uint found = atomic_xchg(&heads[bench_cell(i, cells, distribution)], i);
    if (found == i) heads[0] = 0;
}

kernel void exchange_and_store(volatile global uint* heads, global bench_node* nodes, uint cells,
                               uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const uint next = atomic_xchg(&heads[bench_cell(i, cells, distribution)], i);
    nodes[i] = BENCH_NODE(i, next);
}

// The same with the least that an allocation takes: counters of blocks of 256 nodes, which are
// never full. Compilers make one atomic operation of those of a warp.
kernel void allocate_exchange_and_store(volatile global uint* heads, global bench_node* nodes,
                                        volatile global uint* counters, uint cells,
                                        uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const uint counter = get_group_id(0) & 255u;
    const uint n = atomic_inc(&counters[16u * counter]);
    const uint node = ((n & ~255u) + counter) * 256u + (n & 255u);
    const uint next = atomic_xchg(&heads[bench_cell(i, cells, distribution)], node);
    if (node < count) nodes[node] = BENCH_NODE(i, next);
}

// Traverses every list of exchange_and_store and writes its digest; one work-item a cell.
kernel void read_nodes(global const uint* heads, global const uint* nodes, global uint* digests) {
    const uint cell = get_global_id(0);
    uint digest = 0;
    for (uint node = heads[cell]; node != 0xFFFFFFFFu;) {
        global const uint* words = nodes + (ulong)node * (BENCH_WORDS + 1);
        for (uint j = 0; j < BENCH_WORDS; ++j) digest += bench_digest_word(words[j], j);
        node = words[BENCH_WORDS];
    }
    digests[cell] = digest;
}
