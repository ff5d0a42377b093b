// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/detail/arguments.hpp>
#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/memory.hpp>

namespace cellist::detail {

/// Lists that are contiguous whatever their storage is: those of Storage::counted themselves, else
/// a copy.
class ContiguousLists {
public:
    /// Enqueues the copy, if there must be one. Keeps the memory of the last copy.
    void update(const ListsCore& lists);
    /// Adds what CELLIST_LISTS declares; the mode is CELLIST_CONTIGUOUS.
    void add_to(Arguments& arguments, const ListsCore& lists) const;

private:
    bool is_copy_ = false;
    Memory offsets_;
    Memory records_;
};

}  // namespace cellist::detail
