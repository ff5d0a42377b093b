// SPDX-License-Identifier: MIT
// The digest of each cell's BENCH_NEAREST records with the least keys; one work-item a cell.
#include <cellist/lists.clh>

kernel void nearest(CELLIST_LISTS(RECORD, lists), global uint* digests) {
    const uint cell = get_global_id(0);
    RECORD records[BENCH_NEAREST];
    const uint found = cellist_nearest(lists, cell, key, BENCH_NEAREST, records);
    uint digest = 0;
    for (uint i = 0; i < found; ++i) digest += bench_digest(records[i]);
    digests[cell] = digest;
}
