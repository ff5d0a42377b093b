// The thresholds between the K records of each cell that come first and all others; see modes RANKING
// and CHOOSING in view.h.
//
// One work-item a cell; the range is padded to whole work-groups.
#include <cellist/lists.clh>

// After a ranking pass: the threshold of its word, and how many of the records that equal it are kept.
kernel void cellist_set_thresholds(CELLIST_LISTS(CELLIST_RECORD, lists)) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const ulong at = cellist_row(lists_view, CELLIST_ROW_WANTED, cell);
    const uint wanted = lists_heads[at];
    const uint last = CELLIST_ROW_LEAST + wanted - 1;
    const uint threshold = wanted > 0 ? lists_heads[cellist_row(lists_view, last, cell)] : 0;
    uint less = 0;
    while (less < wanted &&
           lists_heads[cellist_row(lists_view, CELLIST_ROW_LEAST + less, cell)] < threshold)
        ++less;
    const uint row = CELLIST_ROW_LEAST + lists_view.slots + lists_view.rank_words;
    lists_heads[cellist_row(lists_view, row, cell)] = threshold;
    lists_heads[at] = wanted - less;
}

// After a choosing pass: whether the words that were ranked decide, and whether the cell has the records
// that the ranking passes found: those before the thresholds, and as many of their equals as are wanted.
// Where the thresholds are no record's, but the end of all words, there may be fewer.
kernel void cellist_check_choice(CELLIST_LISTS(CELLIST_RECORD, lists),
                                 volatile global cellist_choice* choice) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint wanted = lists_heads[cellist_row(lists_view, CELLIST_ROW_WANTED, cell)];
    const uint equals = lists_heads[cellist_row(lists_view, CELLIST_ROW_EQUALS, cell)];
    if (cell == 0)
        choice->words = cellist_rank_length((struct CELLIST_RECORD*)0, lists_view.rank_member);
    if (equals > wanted) atomic_inc(&choice->undecided);

    int at_the_end = 1;
    for (uint i = 0; i < lists_view.rank_words; ++i)
        if (lists_heads[cellist_row(lists_view, CELLIST_ROW_LEAST + lists_view.slots + i, cell)] !=
            0xFFFFFFFFu)
            at_the_end = 0;
    const uint kept = lists_heads[cell];
    const uint before = lists_view.slots - wanted;
    if (kept != before + min(equals, wanted) || (equals < wanted && !at_the_end))
        atomic_inc(&choice->unrepeated);
}
