// The kernels of bench/sort.cpp: one that fills the lists, and one that reads every record once.
#include <cellist/lists.clh>

uint hash(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// A permutation of 0 ... 2^bits - 1.
uint permuted(uint x, uint bits) {
    const uint mask = (uint)((1ul << bits) - 1ul);
    x = (x * 0x9E3779B1u + 0x7F4A7C15u) & mask;
    x ^= x >> (bits + 1) / 2;
    x = (x * 0x85EBCA6Bu) & mask;
    x ^= x >> (bits + 1) / 2;
    return (x * 0xC2B2AE35u) & mask;
}

// 2^bits work-items. Lists of exactly `length` nodes, a power of two, in scattered order; of random
// lengths if it is 0.
kernel void fill(CELLIST_LISTS(Record, lists), uint bits, uint length) {
    const uint i = get_global_id(0);
    const uint cell = length == 0 ? hash(i) % cellist_cells(lists) : permuted(i, bits) / length;
    const Record record = {(float)hash(~i) * 0x1p-32f, i, ~i};
    cellist_insert(lists, cell, record);
}

kernel void walk(CELLIST_LISTS(Record, lists), global float* sums) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    float sum = 0;
    cellist_for_each(lists, cell, node) {
        const Record record = cellist_get(lists, node);
        sum += record.key + (float)(record.a ^ record.b);
    }
    sums[cell] = sum;
}
