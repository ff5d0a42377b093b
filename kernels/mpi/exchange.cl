// SPDX-License-Identifier: MIT
// Moves records between the ranks of distributed lists: see distributed.clh.
//
// CELLIST_RECORD is the record, and CELLIST_RECORD_TYPE its type. CELLIST_SENT is a struct of a
// record and its cell, in the layout of cellist_node_T. The lists `send` have one cell for each
// rank.
#include <cellist/lists.clh>

// Puts the records of the outbox in the order of the ranks that own their cells. `cuts` is the tree
// of cuts: an axis, a position, and the parts before and from the position on. A negative part
// is the block of rank -1 - part.
//
// One work-item per node of the outbox.
kernel void cellist_route(CELLIST_LISTS(CELLIST_SENT, send),
                          global const struct CELLIST_SENT* outbox,
                          volatile global cellist_shard* shards, const cellist_view pool,
                          const cellist_view domain, global const int4* cuts) {
    const ulong i = get_global_id(0);
    if (i >= pool.pool_nodes || !cellist_is_allocated(shards, pool, (uint)i)) return;
    const struct CELLIST_SENT sent = outbox[i];
    const int4 position = cellist_place_in(domain, sent.cell);
    int part = 0;
    while (part >= 0) {
        const int4 cut = cuts[part];
        const int at = cut.x == 0
                           ? position.x
                           : (cut.x == 1 ? position.y : (cut.x == 2 ? position.z : position.w));
        part = at < cut.y ? cut.z : cut.w;
    }
    cellist_insert(send, -1 - part, sent);
}

// Inserts records that other ranks have sent. Their cells are those of the lists.
//
// One work-item per record.
kernel void cellist_receive(CELLIST_LISTS(CELLIST_RECORD, lists),
                            global const struct CELLIST_SENT* received, const uint count) {
    const ulong i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(lists, received[i].cell, received[i].record);
}

static inline uint cellist_cell_of_box(uint4 at, uint4 extent) {
    return ((at.w * extent.z + at.z) * extent.y + at.y) * extent.x + at.x;
}

// The place of work-item i in a box of cells, x fastest.
static inline uint4 cellist_place_in_box(uint i, uint4 box) {
    const uint row = i / box.x;
    const uint plane = row / box.y;
    return (uint4)(i - row * box.x, row - plane * box.y, plane % box.z, plane / box.z);
}

// The cell of the lists at a place.
static inline uint cellist_cell_at_place(const cellist_view view, uint4 at) {
    return cellist_cell_of_box(
        at, (uint4)(view.extent[0], view.extent[1], view.extent[2], view.extent[3]));
}

// Copies the records of a box of cells, which `rank` has as ghost cells. The box begins at `first`
// in the lists, and at `target` in the lists of that rank, whose extents are `target_extent`.
//
// One work-item per cell of the box.
kernel void cellist_copy_box(CELLIST_LISTS(CELLIST_SENT, send),
                             CELLIST_LISTS(CELLIST_RECORD, lists), const uint4 first,
                             const uint4 box, const uint4 target, const uint4 target_extent,
                             const uint rank) {
    const ulong i = get_global_id(0);
    if (i >= (ulong)box.x * box.y * box.z * box.w) return;
    const uint4 at = cellist_place_in_box((uint)i, box);
    const uint cell = cellist_cell_at_place(cellist_view_of(lists), first + at);
    cellist_for_each(lists, cell, node) {
        struct CELLIST_SENT sent;
        sent.record = cellist_get(lists, node);
        sent.cell = cellist_cell_of_box(target + at, target_extent);
        cellist_insert(send, rank, sent);
    }
}

// The lengths of the lists of the rank's own block; 0 for the other cells.
//
// One work-item per cell.
kernel void cellist_own_lengths(CELLIST_LISTS(CELLIST_RECORD, lists), global uint* lengths,
                                const uint4 first, const uint4 box) {
    const cellist_view view = cellist_view_of(lists);
    const uint cell = get_global_id(0);
    if (cell >= view.cells) return;
    const uint4 extent = (uint4)(view.extent[0], view.extent[1], view.extent[2], view.extent[3]);
    const uint4 at = cellist_place_in_box(cell, extent) - first;
    const bool is_own = at.x < box.x && at.y < box.y && at.z < box.z && at.w < box.w;
    lengths[cell] = is_own ? cellist_length(lists, cell) : 0;
}
