// SPDX-License-Identifier: MIT
// Inserts the records of one rank, one per work-item. The range is padded to whole work-groups.
#include <cellist/lists.clh>

kernel void insert(CELLIST_LISTS(MpiRecord, lists), const MpiInput input) {
    const uint i = get_global_id(0);
    if (i >= input.count) return;
    const uint number = input.first + i;
    const MpiRecord record = {number, bench_hash(number), 3u * number, 5u * number};
    cellist_insert(lists, bench_mpi_cell(input, i), record);
}
