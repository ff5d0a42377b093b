// SPDX-License-Identifier: MIT
// Follows the links of several lists at a time, so that a processor waits for memory once for all
// of them. With 4 M nodes in random places, two cores read them in a quarter of the time.
//
// Included by kernels that read linked lists. The host defines CELLIST_READER_CELLS, the cells of a
// work-item; a work-group has one work-item.
#ifdef CELLIST_READER_CELLS
#define CELLIST_READER_LISTS 16

// The lists of the cells next ... end - 1 and those that are open.
typedef struct cellist_reader {
    uint next, end;
    uint open;
    uint cell[CELLIST_READER_LISTS];
    uint node[CELLIST_READER_LISTS];  // the next one to read
    uint read[CELLIST_READER_LISTS];  // nodes
} cellist_reader;

// The work-item's part of the cells begin ... end - 1.
static inline cellist_reader cellist_reader_of(uint begin, uint end) {
    cellist_reader reader;
    const uint first = begin + min((uint)get_global_id(0) * CELLIST_READER_CELLS, end - begin);
    reader.next = first;
    reader.end = first + min((uint)CELLIST_READER_CELLS, end - first);
    reader.open = 0;
    return reader;
}

// Opens lists. Returns whether any is open.
static inline int cellist_refill(cellist_reader* reader, volatile global const uint* heads) {
    for (; reader->open < CELLIST_READER_LISTS && reader->next < reader->end; ++reader->open) {
        const uint cell = reader->next++;
        reader->cell[reader->open] = cell;
        reader->node[reader->open] = heads[cell];
        reader->read[reader->open] = 0;
    }
    return reader->open > 0;
}

// Loops over the open lists i, until all lists are closed. The body calls cellist_advance for a
// list or closes it.
#define cellist_for_each_open(reader, lists, i)                                                    \
    while (cellist_refill(&(reader), lists##_heads))                                               \
        for (uint i = 0; i < (reader).open; ++i)

// Counts the node of a list as read, and goes on to the next.
#define cellist_advance(reader, lists, i)                                                          \
    ((reader).node[i] = lists##_nodes[(reader).node[i]].next, ++(reader).read[i])

// Puts the last open list in the place of another.
static inline void cellist_close(cellist_reader* reader, uint i) {
    const uint last = --reader->open;
    reader->cell[i] = reader->cell[last];
    reader->node[i] = reader->node[last];
    reader->read[i] = reader->read[last];
}
#endif
