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
// need not be sorted either, and *longer becomes 1 where one has N fragments or more.
#ifdef OIT_SORTED
#define OIT_LONGER , global uint* longer

// The nodes of a list in order, up to OIT_SORTED of them; returns how many. Their keys move, and
// the nodes stay: other members matter only where keys are equal.
static inline uint oit_sort_list(CELLIST_LISTS(OIT_NODE, fragments), uint cell, uint* nodes) {
    uint keys[OIT_SORTED];
    uint found = 0;
    cellist_for_each(fragments, cell, node) {
        if (found == OIT_SORTED) break;
        const uint key = cellist_get(fragments, node).key;
        uint at = found++;
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
    return found;
}
#else
#define OIT_LONGER
#endif

kernel void oit_resolve_lists(CELLIST_LISTS(OIT_NODE, fragments) OIT_LONGER, OIT_SCREEN) {
    OitPixel pixel;
    if (!oit_pixel(OIT_SCREEN_PASS, &pixel)) return;
    const uint cell = cellist_cell3(fragments, pixel.x, pixel.y, pixel.eye);
    OitBlendState blended = oit_blend_state();
#ifdef OIT_SORTED
    uint nodes[OIT_SORTED];
    uint found = oit_sort_list(CELLIST_PASS(fragments), cell, nodes);
    if (found == OIT_SORTED) *longer = 1;
#ifdef OIT_LAYERS
    found = min(found, (uint)OIT_LAYERS);
#endif
    for (uint i = 0; i < found && !oit_done(&blended, &pixel); ++i) {
        const OitFragment fragment = oit_unpack(&pixel.frame, cellist_get(fragments, nodes[i]));
        oit_add(&blended, &pixel, &fragment);
    }
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
