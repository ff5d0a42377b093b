// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <cellist/options.hpp>

#include "support/catch.hpp"

namespace cellist::test {

/// Whether each cell has a fixed number of slots, which limits a list instead of the capacity.
constexpr bool has_slots(Storage storage) { return storage == Storage::fixed; }

/// Runs the rest of the test case once for each storage, and names it where an assertion fails in
/// the same scope.
#define CELLIST_EACH_STORAGE(name)                                                                 \
    const cellist::Storage name = GENERATE(from_range(cellist::all_storages));                     \
    INFO("storage " << cellist::name_of(name))

}  // namespace cellist::test
