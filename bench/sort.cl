// SPDX-License-Identifier: MIT
// Counts the nodes whose key is less than that of the node before; one work-item a cell.
#include <cellist/lists.clh>

kernel void count_unsorted(CELLIST_LISTS(RECORD, lists), volatile global uint* unsorted) {
    const uint cell = get_global_id(0);
    uint before = 0;
    cellist_for_each(lists, cell, node) {
        const uint key = cellist_get(lists, node).key;
        if (key < before) atomic_inc(unsorted);
        before = key;
    }
}

// Leaves `distinct` different keys in each list; one work-item a cell.
kernel void tie_keys(CELLIST_LISTS(RECORD, lists), uint distinct) {
    const uint cell = get_global_id(0);
    cellist_for_each(lists, cell, node) cellist_get(lists, node).key %= distinct;
}
