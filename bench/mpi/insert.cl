// SPDX-License-Identifier: MIT
// Inserts of the records of one rank, one from each work-item; launched over whole work-groups.
#include <cellist/lists.clh>

kernel void insert(CELLIST_LISTS(MpiRecord, lists), const MpiInput input) {
    const uint i = get_global_id(0);
    if (i >= input.count) return;
    const uint number = input.first + i;
    const MpiRecord record = {number, bench_hash(number), 3u * number, 5u * number};
    cellist_insert(lists, bench_mpi_cell(input, i), record);
}
