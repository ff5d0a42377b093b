#pragma once

#include <array>
#include <string_view>

#include <cellist/options.hpp>

#include "support/catch.hpp"

namespace cellist::test {

inline constexpr std::array all_storages{Storage::linked, Storage::counted, Storage::fixed};

/// Runs the rest of the test case once for each storage, and names it where an assertion fails in
/// the same scope.
#define CELLIST_EACH_STORAGE(name)                                                                 \
    const cellist::Storage name =                                                                  \
        GENERATE(cellist::Storage::linked, cellist::Storage::counted, cellist::Storage::fixed);    \
    INFO("storage " << cellist::name_of(name))

}  // namespace cellist::test
