// SPDX-License-Identifier: MIT
// The thresholds between the K records of each cell that come first and all others; see
// nearest.clh.
//
// One work-item per cell; the range is padded to whole work-groups.
#include <cellist/lists.clh>

// After a threshold pass: the threshold of its word, and how many of the records that equal it are
// kept.
kernel void cellist_set_thresholds(CELLIST_LISTS(CELLIST_RECORD, lists)) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const ulong at = cellist_row(lists_view, CELLIST_ROW_REMAINING, cell);
    const uint remaining = lists_heads[at];
    const uint last = CELLIST_ROW_LEAST + remaining - 1;
    const uint threshold = remaining > 0 ? lists_heads[cellist_row(lists_view, last, cell)] : 0;
    uint less = 0;
    while (less < remaining &&
           lists_heads[cellist_row(lists_view, CELLIST_ROW_LEAST + less, cell)] < threshold)
        ++less;
    const uint row = CELLIST_ROW_LEAST + lists_view.slots + lists_view.threshold_words;
    lists_heads[cellist_row(lists_view, row, cell)] = threshold;
    lists_heads[at] = remaining - less;
}

// After a selection pass: whether the thresholds decide, and whether the cell has the records that
// the threshold passes found: those before the thresholds, and as many of their equals as remain.
// If all thresholds are the largest word, no record defined them, and there may be fewer.
kernel void cellist_check_selection(CELLIST_LISTS(CELLIST_RECORD, lists),
                                    volatile global cellist_selection* selection) {
    const cellist_view lists_view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    const uint remaining = lists_heads[cellist_row(lists_view, CELLIST_ROW_REMAINING, cell)];
    const uint equals = lists_heads[cellist_row(lists_view, CELLIST_ROW_EQUALS, cell)];
    if (cell == 0)
        selection->words = cellist_record_words((CELLIST_RECORD_TYPE*)0, lists_view.key_member);
    if (equals > remaining) atomic_inc(&selection->undecided);

    int at_the_end = 1;
    for (uint i = 0; i < lists_view.threshold_words; ++i)
        if (cellist_threshold(lists_heads, lists_view, i, cell) != 0xFFFFFFFFu) at_the_end = 0;
    const uint kept = lists_heads[cell];
    const uint before = lists_view.slots - remaining;
    if (kept != before + min(equals, remaining) || (equals < remaining && !at_the_end))
        atomic_inc(&selection->unrepeated);
}
