// Checks the places of lists that lie in one piece: that they follow one another inside the pool, and
// that each was filled.
//
//   findings   1   in: 0 and first_bad_cell = CELLIST_NONE; out: the counts
//
// One work-item a cell; the range is padded to whole work-groups.
#include <cellist/lists.clh>

// As struct PieceFindings in storage_counted.cpp.
typedef struct cellist_piece_findings {
    uint broken_places;   // cells whose place ends before it begins, or behind the pool
    uint unfilled_cells;  // cells with fewer records than their place has nodes
    uint first_bad_cell;  // lowest of both
} cellist_piece_findings;

kernel void cellist_pieces(CELLIST_LISTS(CELLIST_RECORD, lists),
                           volatile global cellist_piece_findings* findings) {
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint begin = lists_heads[cell];
    const uint end = lists_heads[cell + 1];
    const uint filled = lists_heads[lists_view.cells + 1 + cell];
    const int broken = begin > end || end > lists_view.capacity_nodes;
    // A list counts on past its place: those records were dropped.
    const int unfilled = !broken && filled < end - begin;
    if (broken) atomic_inc(&findings->broken_places);
    if (unfilled) atomic_inc(&findings->unfilled_cells);
    if (broken || unfilled) atomic_min(&findings->first_bad_cell, cell);
}
