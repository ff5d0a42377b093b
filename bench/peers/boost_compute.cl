// SPDX-License-Identifier: MIT
// The steps of the Boost.Compute path after its sort: bounds, and one read of every list.

// Finds where each cell's items begin in sorted cells. One work-item for each item and one more;
// offsets has cell_count + 1 elements.
kernel void find_bounds(global const uint* cells, uint count, uint cell_count,
                        global uint* offsets) {
    const uint i = get_global_id(0);
    if (i > count) return;
    const uint first = i == 0 ? 0 : cells[i - 1] + 1;
    const uint last = i == count ? cell_count : cells[i];
    for (uint cell = first; cell <= last; ++cell) offsets[cell] = i;
}

// Records are the first three words of a uint4.
kernel void read_values(global const uint* offsets, global const uint4* values,
                        global uint* digests) {
    const uint cell = get_global_id(0);
    uint digest = 0;
    for (uint i = offsets[cell]; i < offsets[cell + 1]; ++i) {
        const uint4 value = values[i];
        digest += bench_digest_word(value.x, 0) + bench_digest_word(value.y, 1) +
                  bench_digest_word(value.z, 2);
    }
    digests[cell] = digest;
}

// Records stay in place, and are read through indices.
kernel void read_indexed(global const uint* offsets, global const uint* indices,
                         global const RECORD* records, global uint* digests) {
    const uint cell = get_global_id(0);
    uint digest = 0;
    for (uint i = offsets[cell]; i < offsets[cell + 1]; ++i)
        digest += bench_digest(records[indices[i]]);
    digests[cell] = digest;
}

// The input: cells, and values, which are records of four words or their indices.
kernel void store_values(global uint* cells, global uint4* values, uint cell_count,
                         uint distribution) {
    const uint i = get_global_id(0);
    cells[i] = bench_cell(i, cell_count, distribution);
    values[i] = (uint4)(bench_word(i, 0), bench_word(i, 1), bench_word(i, 2), 0);
}

kernel void store_indices(global uint* cells, global uint* indices, global RECORD* records,
                          uint cell_count, uint distribution) {
    const uint i = get_global_id(0);
    cells[i] = bench_cell(i, cell_count, distribution);
    indices[i] = i;
    records[i] = bench_record(i);
}
