// SPDX-License-Identifier: MIT
// Traverses every list once and writes its digest: one work-item and one element of `digests` a
// cell.
#include <cellist/lists.clh>

kernel void read(CELLIST_LISTS(RECORD, lists), global uint* digests) {
    const uint cell = get_global_id(0);
    uint digest = 0;
    cellist_for_each(lists, cell, node) digest += bench_digest(cellist_get(lists, node));
    digests[cell] = digest;
}

// The same for contiguous lists: list c ends where list c + 1 begins.
kernel void read_packed(global const uint* offsets, global const RECORD* records,
                        global uint* digests) {
    const uint cell = get_global_id(0);
    uint digest = 0;
    for (uint i = offsets[cell]; i < offsets[cell + 1]; ++i) digest += bench_digest(records[i]);
    digests[cell] = digest;
}
