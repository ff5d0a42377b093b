// Whether the filling pass of a counted build inserted what the counting pass had counted.
//
//   differing   1   in: 0; out: cells whose list is not as long as its place
//
// One work-item a cell; the range is padded to whole work-groups.
#include <cellist/lists.clh>

kernel void cellist_repeats(CELLIST_LISTS(CELLIST_RECORD, lists), volatile global uint* differing) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint place = lists_heads[cell + 1] - lists_heads[cell];
    const uint filled = lists_heads[lists_view.cells + 1 + cell];
    // Past its place a list counts on: those records were dropped.
    if (filled < place) atomic_inc(differing);
}
