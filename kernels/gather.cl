// Copies a value of each record of a range of lists into one array, in the order of the lists.
//
//   offsets   cells + 1          where each list goes, counted from the first list of all
//   values    offsets[end] - offsets[begin]   out
//
// One work-item for each cell in begin ... end - 1; the range is padded to whole work-groups. The
// host defines CELLIST_VALUE, which declares a variable for a value, and CELLIST_MEMBER, which
// selects the value when it follows a record.
#include <cellist/lists.clh>

// A struct, because arrays are values too, and C assigns no arrays.
typedef struct cellist_gathered {
    CELLIST_VALUE;
} cellist_gathered;

kernel void cellist_gather(CELLIST_LISTS(CELLIST_RECORD, lists), uint begin, uint end,
                           global const uint* offsets, global cellist_gathered* values) {
    const size_t item = get_global_id(0);
    if (item >= end - begin) return;
    const uint cell = begin + (uint)item;
    uint at = offsets[cell] - offsets[begin];
    const uint list_end = offsets[cell + 1] - offsets[begin];
    cellist_for_each(lists, cell, node) {
        if (at == list_end) break;
        values[at++] = *(global const cellist_gathered*)&(cellist_get(lists, node) CELLIST_MEMBER);
    }
}
