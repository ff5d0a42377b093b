// SPDX-License-Identifier: MIT
// The fragments of one pixel: a list in a container of one cell.
#define OIT_TARGET CELLIST_LISTS(PixelFragment, fragments), uint wanted
#define OIT_TARGET_PASS CELLIST_PASS(fragments), wanted

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    if (location->pixel != wanted) return;
    const PixelFragment record = {fragment->depth,
                                  {fragment->colour.x, fragment->colour.y, fragment->colour.z},
                                  fragment->alpha,
                                  fragment->blend,
                                  fragment->coverage};
    cellist_insert(fragments, 0, record);
}
