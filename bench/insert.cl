// One insert from each work-item, whatever its neighbours do: of a record that it computes, or of
// one that it reads. Launched over `count` work-items or more.
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
