// SPDX-License-Identifier: MIT
// Reads every record once, list by list: what any kernel that reads the lists takes at least.
//
//   found   2   in and out: at least the length of the longest list; nothing of use
//
// One work-item per cell; the range is padded to whole work-groups. A list is left after `most`
// records. The host defines CELLIST_WORD, the largest of uchar and uint that divides the record.
#include <cellist/lists.clh>

kernel void cellist_traverse(CELLIST_LISTS(CELLIST_RECORD, lists), uint most,
                             volatile global uint* found) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint length = 0;
    uint sum = 0;
    cellist_for_each(lists, cell, node) {
        if (length == most) break;
        global const CELLIST_WORD* words = (global const CELLIST_WORD*)&cellist_get(lists, node);
        for (uint i = 0; i < sizeof(CELLIST_RECORD_TYPE) / sizeof(CELLIST_WORD); ++i)
            sum += words[i];
        ++length;
    }
    // The read is a hint that saves most atomics.
    if (length > found[0]) atomic_max(&found[0], length);
    // Keeps the compiler from leaving out the reads.
    if (sum == CELLIST_NONE) atomic_max(&found[1], sum);
}
