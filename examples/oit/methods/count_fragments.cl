// SPDX-License-Identifier: MIT
// How many fragments there are in each pixel.
#define OIT_TARGET volatile global uint* counts
#define OIT_TARGET_PASS counts

static inline void oit_store(OIT_TARGET, const OitFrame* frame, const OitLocation* location,
                             const OitFragment* fragment) {
    atomic_inc(&counts[location->pixel]);
}
