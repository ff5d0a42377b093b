// SPDX-License-Identifier: MIT
// The methods that keep every fragment in a list of its pixel, whatever the storage (Yang et al.
// 2010, section 4.1). A container of shape width x height, or width x height x eyes.

#ifdef OIT_STORES
#define OIT_TARGET CELLIST_LISTS(OIT_NODE, fragments)
#define OIT_TARGET_PASS CELLIST_PASS(fragments)

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    cellist_insert(fragments, cellist_cell3(fragments, location->x, location->y, location->eye),
                   oit_pack(frame, fragment));
}

#else

// Blends each pixel's fragments front to back over what is behind them.
//
// The lists are sorted by key. With OIT_NEAREST=K they need not be, and the K nearest fragments of
// each are blended; OIT_LAYERS=K stops after the first K of a sorted list. With OIT_SORTED=N they
// need not be sorted either. If one has N fragments or more, the kernel leaves the note `longer`.
// With OIT_STRIP=N, too, each work-item blends N places of a row.
#ifdef OIT_SORTED
#define OIT_LONGER , global RasterCounts *bin_counts, const uint longer

// Fragments of a list by key and node, up to OIT_SORTED of them. Their nodes stay in place.
typedef struct {
    uint keys[OIT_SORTED];
    uint nodes[OIT_SORTED];
    uint found;
} OitEntries;

// Most fragments that are blended.
#ifndef OIT_LAYERS
#define OIT_LAYERS OIT_SORTED
#endif

static inline void oit_blend_node(CELLIST_LISTS(OIT_NODE, fragments), uint node,
                                  const OitPixel* pixel, OitBlendState* blended) {
    const OitFragment fragment = oit_unpack(&pixel->frame, cellist_get(fragments, node));
    oit_add(blended, pixel, &fragment);
}

// Puts one more fragment in its place among the first `found`, which are in order. Other members
// than the key matter only where keys are equal.
static inline void oit_insert_entry(CELLIST_LISTS(OIT_NODE, fragments), OitEntries* entries,
                                    uint found, uint key, uint node) {
    uint* keys = entries->keys;
    uint* nodes = entries->nodes;
    uint at = found;
    for (; at > 0 && key <= keys[at - 1]; --at) {
        if (key == keys[at - 1] &&
            !cellist_record_before(cellist_get(fragments, node),
                                   cellist_get(fragments, nodes[at - 1]), cellist_key_key))
            break;
        keys[at] = keys[at - 1];
        nodes[at] = nodes[at - 1];
    }
    keys[at] = key;
    nodes[at] = node;
}

// Sorts entries: at least those that are blended.
static inline void oit_sort_entries(CELLIST_LISTS(OIT_NODE, fragments), OitEntries* entries) {
    for (uint i = 1; i < entries->found; ++i) {
        const uint key = entries->keys[i];
        if (i >= OIT_LAYERS && key > entries->keys[OIT_LAYERS - 1]) continue;
        oit_insert_entry(CELLIST_PASS(fragments), entries, min(i, (uint)OIT_LAYERS), key,
                         entries->nodes[i]);
    }
}

// Blends sorted entries.
static inline void oit_blend_entries(CELLIST_LISTS(OIT_NODE, fragments), const OitEntries* entries,
                                     const OitPixel* pixel, OitBlendState* blended) {
    const uint layers = min(entries->found, (uint)OIT_LAYERS);
    for (uint i = 0; i < layers && !oit_done(blended, pixel); ++i)
        oit_blend_node(CELLIST_PASS(fragments), entries->nodes[i], pixel, blended);
}

#ifdef OIT_RUN
// Long lists are sorted in runs of OIT_RUN, in registers, by Batcher's odd-even merge sort.
// clang-format off
#define OIT_NETWORK(X)                                                                             \
    X(0, 1) X(2, 3) X(4, 5) X(6, 7) X(8, 9) X(10, 11) X(12, 13) X(14, 15) X(0, 2) X(1, 3)          \
    X(4, 6) X(5, 7) X(8, 10) X(9, 11) X(12, 14) X(13, 15) X(1, 2) X(5, 6) X(9, 10) X(13, 14)       \
    X(0, 4) X(1, 5) X(2, 6) X(3, 7) X(8, 12) X(9, 13) X(10, 14) X(11, 15) X(2, 4) X(3, 5)          \
    X(10, 12) X(11, 13) X(1, 2) X(3, 4) X(5, 6) X(9, 10) X(11, 12) X(13, 14) X(0, 8) X(1, 9)       \
    X(2, 10) X(3, 11) X(4, 12) X(5, 13) X(6, 14) X(7, 15) X(4, 8) X(5, 9) X(6, 10) X(7, 11)        \
    X(2, 4) X(3, 5) X(6, 8) X(7, 9) X(10, 12) X(11, 13) X(1, 2) X(3, 4) X(5, 6) X(7, 8) X(9, 10)   \
    X(11, 12) X(13, 14)
// clang-format on

#define OIT_EXCHANGE(a, b) oit_exchange(&keys[a], &nodes[a], &keys[b], &nodes[b]);

static inline void oit_exchange(uint* key, uint* node, uint* other_key, uint* other_node) {
    const bool swaps = *other_key < *key;
    const uint least = swaps ? *other_key : *key, greatest = swaps ? *key : *other_key;
    const uint first = swaps ? *other_node : *node, second = swaps ? *node : *other_node;
    *key = least;
    *other_key = greatest;
    *node = first;
    *other_node = second;
}

static inline void oit_sort_runs(OitEntries* entries) {
    for (uint begin = 0; begin < entries->found; begin += OIT_RUN) {
        uint keys[OIT_RUN], nodes[OIT_RUN];
#pragma unroll
        for (uint i = 0; i < OIT_RUN; ++i) {
            const bool exists = begin + i < entries->found;
            keys[i] = exists ? entries->keys[begin + i] : CELLIST_NONE;
            nodes[i] = exists ? entries->nodes[begin + i] : CELLIST_NONE;
        }
        OIT_NETWORK(OIT_EXCHANGE)
#pragma unroll
        for (uint i = 0; i < OIT_RUN; ++i)
            if (begin + i < entries->found) {
                entries->keys[begin + i] = keys[i];
                entries->nodes[begin + i] = nodes[i];
            }
    }
}

// Merges the runs and blends. False where two keys are equal, because other members decide then,
// or where a key could be none.
static inline bool oit_blend_runs(CELLIST_LISTS(OIT_NODE, fragments), const OitEntries* entries,
                                  const OitPixel* pixel, OitBlendState* blended) {
    uint at[OIT_SORTED / OIT_RUN], keys[OIT_SORTED / OIT_RUN];
#pragma unroll
    for (uint run = 0; run < OIT_SORTED / OIT_RUN; ++run) {
        at[run] = run * OIT_RUN;
        keys[run] = at[run] < entries->found ? entries->keys[at[run]] : CELLIST_NONE;
    }
    uint previous = CELLIST_NONE;
    for (uint layer = 0; layer < entries->found; ++layer) {
        uint key = keys[0], first = 0, place = at[0];
#pragma unroll
        for (uint run = 1; run < OIT_SORTED / OIT_RUN; ++run)
            if (keys[run] < key) {
                key = keys[run];
                first = run;
                place = at[run];
            }
        if (key == previous || key == CELLIST_NONE) return false;
        if (layer >= OIT_LAYERS || oit_done(blended, pixel)) break;
        previous = key;
        const uint next = place + 1;
        const uint next_key =
            next % OIT_RUN != 0 && next < entries->found ? entries->keys[next] : CELLIST_NONE;
#pragma unroll
        for (uint run = 0; run < OIT_SORTED / OIT_RUN; ++run)
            if (run == first) {
                at[run] = next;
                keys[run] = next_key;
            }
        oit_blend_node(CELLIST_PASS(fragments), entries->nodes[place], pixel, blended);
    }
    return true;
}
#endif

// Blends a list nearest first.
static inline void oit_blend_list(CELLIST_LISTS(OIT_NODE, fragments), uint cell,
                                  OitEntries* entries, const OitPixel* pixel,
                                  OitBlendState* blended) {
    uint found = 0;
    cellist_for_each(fragments, cell, node) {
        if (found == OIT_SORTED) break;
        const uint key = cellist_get(fragments, node).key;
#ifdef OIT_RUN
        entries->keys[found] = key;
        entries->nodes[found++] = node;
#else
        oit_insert_entry(CELLIST_PASS(fragments), entries, found++, key, node);
#endif
    }
    entries->found = found;
#ifdef OIT_RUN
    // Insertion is faster for few.
    if (found > OIT_RUN / 2) {
        oit_sort_runs(entries);
        if (oit_blend_runs(CELLIST_PASS(fragments), entries, pixel, blended)) return;
        *blended = oit_blend_state();
    }
    oit_sort_entries(CELLIST_PASS(fragments), entries);
#endif
    oit_blend_entries(CELLIST_PASS(fragments), entries, pixel, blended);
}
#else
#define OIT_LONGER
#endif

#ifdef OIT_STRIP
// Finds the entries of the lists of a strip. A processor waits for the nodes of many lists at once
// if it visits one node of each at a time.
static inline void oit_find_entries(CELLIST_LISTS(OIT_NODE, fragments), uint first,
                                    OitEntries* entries) {
    uint visited[OIT_STRIP], next[OIT_STRIP], end[OIT_STRIP];
    uint lists = 0;
    for (uint i = 0; i < OIT_STRIP; ++i) {
        const uint cell =
            cellist_cell3(fragments, (first + i) / OIT_PLACES, get_global_id(1), get_global_id(2));
        entries[i].found = 0;
        end[i] = cellist_end(fragments_heads, cellist_view_of(fragments), cell);
        next[i] = cellist_begin(fragments_heads, cellist_view_of(fragments), cell);
        visited[lists] = i;
        if (next[i] < end[i]) ++lists;
    }
    for (uint n = 0; n < OIT_SORTED && lists > 0; ++n) {
        uint more = 0;
        for (uint k = 0; k < lists; ++k) {
            const uint i = visited[k], node = next[i];
            entries[i].keys[n] = cellist_get(fragments, node).key;
            entries[i].nodes[n] = node;
            entries[i].found = n + 1;
            next[i] = cellist_next(fragments_nodes, fragments_typed, node);
            visited[more] = i;
            if (next[i] < end[i]) ++more;
        }
        lists = more;
    }
}

kernel void oit_resolve_lists(CELLIST_LISTS(OIT_NODE, fragments) OIT_LONGER, OIT_SCREEN) {
    OitEntries entries[OIT_STRIP];
    const uint first = get_global_id(0) * OIT_STRIP;
    oit_find_entries(CELLIST_PASS(fragments), first, entries);
    for (uint i = 0; i < OIT_STRIP; ++i) {
        OitPixel pixel;
        if (!oit_pixel_at(OIT_SCREEN_PASS, first + i, &pixel)) continue;
        OitBlendState blended = oit_blend_state();
        oit_sort_entries(CELLIST_PASS(fragments), &entries[i]);
        oit_blend_entries(CELLIST_PASS(fragments), &entries[i], &pixel, &blended);
        if (entries[i].found == OIT_SORTED) bin_counts->note = longer;
        oit_write(OIT_SCREEN_PASS, &pixel, &blended);
    }
}
#else
kernel void oit_resolve_lists(CELLIST_LISTS(OIT_NODE, fragments) OIT_LONGER, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const uint cell = cellist_cell3(fragments, pixel.x, pixel.y, pixel.eye);
    OitBlendState blended = oit_blend_state();
#ifdef OIT_SORTED
    OitEntries entries;
    oit_blend_list(CELLIST_PASS(fragments), cell, &entries, &pixel, &blended);
    if (entries.found == OIT_SORTED) bin_counts->note = longer;
#elif defined(OIT_NEAREST)
    struct OIT_NODE nearest[OIT_NEAREST];
    const uint found = cellist_nearest(fragments, cell, key, OIT_NEAREST, nearest);
    for (uint i = 0; i < found && !oit_done(&blended, &pixel); ++i) {
        const OitFragment fragment = oit_unpack(&pixel.frame, nearest[i]);
        oit_add(&blended, &pixel, &fragment);
    }
#else
    uint layer = 0;
    cellist_for_each(fragments, cell, node) {
#ifdef OIT_LAYERS
        if (layer++ == OIT_LAYERS) break;
#endif
        if (oit_done(&blended, &pixel)) break;
        const OitFragment fragment = oit_unpack(&pixel.frame, cellist_get(fragments, node));
        oit_add(&blended, &pixel, &fragment);
    }
#endif
    oit_write(OIT_SCREEN_PASS, &pixel, &blended);
}
#endif

#endif
