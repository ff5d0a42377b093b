// SPDX-License-Identifier: MIT
// The cell and the words of the i-th insert. Compiled as OpenCL C, C++ and CUDA, so that every
// device and every peer has the same input.
//
// The number of cells is a power of two. A division would take longer than the measured operation.
#ifndef CELLIST_BENCH_DISTRIBUTION_H
#define CELLIST_BENCH_DISTRIBUTION_H

#ifdef __OPENCL_VERSION__
typedef uint bench_uint;
#define BENCH_FUNCTION static inline
#define BENCH_LEADING_ZEROS(x) clz(x)
#else
#include <math.h>
#include <stdint.h>
typedef uint32_t bench_uint;
#if defined(__CUDA_ARCH__)
#define BENCH_LEADING_ZEROS(x) static_cast<bench_uint>(__clz(static_cast<int>(x)))
#else
#define BENCH_LEADING_ZEROS(x) static_cast<bench_uint>(__builtin_clz(x))
#endif
#ifdef __CUDACC__
#define BENCH_FUNCTION static inline __host__ __device__
#else
#define BENCH_FUNCTION inline
#endif
#endif

#define BENCH_RANDOM 0u    // hashed cells
#define BENCH_COHERENT 1u  // neighbouring inserts hit neighbouring cells, as a rasteriser's do
#define BENCH_RUNS 2u      // 16 consecutive inserts share a hashed cell
#define BENCH_SKEWED 3u    // the k-th most frequent cell has a share of about 1/k (Zipf)
#define BENCH_HOT 4u       // all in one cell

// A hash of 32 bits, one to one (Chris Wellons, "Prospecting for Hash Functions", 2018).
BENCH_FUNCTION bench_uint bench_hash(bench_uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// A rank from 0 to cells - 2: rank k with a probability of about 1 / k. Each power of two of ranks
// is as likely as any other. The ranks are spread over the cells.
BENCH_FUNCTION bench_uint bench_skewed_cell(bench_uint i, bench_uint cells) {
    const bench_uint hash = bench_hash(i);
    const bench_uint octaves = 31u - BENCH_LEADING_ZEROS(cells);
    const bench_uint octave = ((hash >> 16) * octaves) >> 16;
    const bench_uint first = (1u << octave) - 1u;
    const bench_uint rank = first + (bench_hash(hash) & first);
    return (rank * 0x9e3779b1u) & (cells - 1u);
}

BENCH_FUNCTION bench_uint bench_cell(bench_uint i, bench_uint cells, bench_uint distribution) {
    switch (distribution) {
        case BENCH_RANDOM:
            return bench_hash(i) & (cells - 1u);
        case BENCH_COHERENT:
            return i & (cells - 1u);
        case BENCH_RUNS:
            return bench_hash(i / 16u) & (cells - 1u);
        case BENCH_SKEWED:
            return bench_skewed_cell(i, cells);
        default:
            return 0u;
    }
}

// The j-th word of the i-th record. Word 0 is the sort key; no two are equal. In random cells it
// costs nothing, because the cell comes from the same hash.
BENCH_FUNCTION bench_uint bench_word(bench_uint i, bench_uint j) {
    return j == 0u ? bench_hash(i) : i * (2u * j + 1u);
}

// The contribution of a record's j-th word to the digest of its list.
BENCH_FUNCTION bench_uint bench_digest_word(bench_uint word, bench_uint j) {
    return word * (2u * j + 1u);
}

// The rest is for hosts.
#ifndef __OPENCL_VERSION__

// nodes / occupancy, rounded down to a power of two, and at least 1.
inline bench_uint bench_cells(bench_uint nodes, bench_uint occupancy) {
    bench_uint cells = 1;
    while (cells <= nodes / occupancy / 2) cells *= 2;
    return cells;
}

// The approximate length of the longest list; an upper bound in all but rare cases.
inline double bench_longest(bench_uint nodes, bench_uint cells, bench_uint distribution) {
    const double mean = static_cast<double>(nodes) / cells;
    // Five standard deviations over the mean of a Poisson distribution, with a margin for small
    // means.
    const auto tail = [](double expected) { return expected + 5 * sqrt(expected) + 5; };
    switch (distribution) {
        case BENCH_COHERENT:
            return ceil(mean);
        case BENCH_RUNS:
            return 16 * tail(mean / 16);
        case BENCH_SKEWED:
            return cells < 4 ? nodes : nodes / log2(static_cast<double>(cells));
        case BENCH_HOT:
            return nodes;
        default:
            return tail(mean);
    }
}

// The longest list that one work-item or thread traverses in a benchmark.
#define BENCH_READABLE_NODES 32768.0

// The number of nodes, halved until one work-item can traverse each list.
inline bench_uint bench_readable_nodes(bench_uint nodes, bench_uint occupancy,
                                       bench_uint distribution) {
    while (bench_longest(nodes, bench_cells(nodes, occupancy), distribution) > BENCH_READABLE_NODES)
        nodes /= 2;
    return nodes;
}

#endif

#endif
