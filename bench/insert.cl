// Inserts of `count` records, in the different ways that there are. Unless it says otherwise, one from each
// work-item, whatever its neighbours do; launched over whole work-groups.
#include <cellist/lists.clh>

kernel void insert(CELLIST_LISTS(RECORD, lists), uint distribution, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(lists, bench_cell(i, cellist_cells(lists), distribution), bench_record(i));
}

kernel void insert_stored(CELLIST_LISTS(RECORD, lists), global const uint* cells,
                          global const RECORD* records, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(lists, cells[i], records[i]);
}

// Whole work-groups together.
kernel void insert_all(CELLIST_LISTS(RECORD, lists), uint distribution, uint count) {
    local cellist_group group;
    const uint i = get_global_id(0);
    cellist_insert_all(lists, group, i < count, bench_cell(i, cellist_cells(lists), distribution),
                       bench_record(i));
}

// Four records from each work-item, in nodes that it reserves. Neighbours insert neighbouring records.
kernel void insert_reserved(CELLIST_LISTS(RECORD, lists), uint distribution, uint count) {
    const uint items = (count + 3) / 4;
    const uint item = get_global_id(0);
    if (item >= items) return;
    cellist_reservation nodes = cellist_reserve(lists, 4);
    for (uint i = item; i < count; i += items)
        cellist_link(lists, bench_cell(i, cellist_cells(lists), distribution), nodes,
                     bench_record(i));
}
