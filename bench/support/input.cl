// SPDX-License-Identifier: MIT
// Writes the cells and records of a workload to arrays. `cells` and `records` have one element for
// each work-item.

kernel void store_input(global uint* cells, global RECORD* records, uint cell_count,
                        uint distribution) {
    const uint i = get_global_id(0);
    cells[i] = bench_cell(i, cell_count, distribution);
    records[i] = bench_record(i);
}
