// Copies a range of lists into one array, one list behind the other, in the order of the lists.
//
//   offsets   cells + 1          where each list goes, counted from the first list of all
//   records   offsets[end] - offsets[begin]   out
//
// One work-item for each cell in begin ... end - 1; the range is padded to whole work-groups.
#include <cellist/lists.clh>

kernel void cellist_gather(CELLIST_LISTS(CELLIST_RECORD, lists), uint begin, uint end,
                           global const uint* offsets, global struct CELLIST_RECORD* records) {
    const size_t item = get_global_id(0);
    if (item >= end - begin) return;
    const uint cell = begin + (uint)item;
    uint at = offsets[cell] - offsets[begin];
    cellist_for_each(lists, cell, node) records[at++] = cellist_get(lists, node);
}
