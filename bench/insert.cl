// The inserting kernels of bench/insert.cpp, and their ceilings: the same stores and exchanges, with
// the work-item's index as the address instead of an allocation.
#include <cellist/lists.clh>

// pattern, as in insert.cpp
#define RANDOM 0
#define COHERENT 1
#define RUNS 2

uint hash(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

uint cell_of(uint i, uint cells, uint pattern) {
    switch (pattern) {
        case RANDOM:
            return hash(i) % cells;
        case COHERENT:
            return i % cells;
        case RUNS:
            return hash(i / 16) % cells;
        default:
            return 0;  // hot: all in one cell
    }
}

Record record_of(uint i) {
    const Record record = {i, ~i, i * 3};
    return record;
}

kernel void insert(CELLIST_LISTS(Record, lists), uint pattern) {
    const uint i = get_global_id(0);
    cellist_insert(lists, cell_of(i, cellist_cells(lists), pattern), record_of(i));
}

kernel void exchange_and_store(CELLIST_LISTS(Record, lists), uint pattern) {
    const uint i = get_global_id(0);
    lists_nodes[i].record = record_of(i);
    lists_nodes[i].next = atomic_xchg(&lists_heads[cell_of(i, cellist_cells(lists), pattern)], i);
}

kernel void store(CELLIST_LISTS(Record, lists), uint pattern) {
    const uint i = get_global_id(0);
    lists_nodes[i].record = record_of(i);
    lists_nodes[i].next = cell_of(i, cellist_cells(lists), pattern);
}
