#pragma once

#include <array>
#include <string_view>

#include <cellist/options.hpp>

#include "support/catch.hpp"

namespace cellist::test {

inline constexpr std::array all_storages{Storage::linked, Storage::counted, Storage::fixed};

constexpr std::string_view name_of(Storage storage) {
    switch (storage) {
        case Storage::linked:
            return "linked";
        case Storage::counted:
            return "counted";
        case Storage::fixed:
            return "fixed";
        case Storage::automatic:
            return "automatic";
    }
    return "unknown";
}

/// Runs the rest of the test case once for each storage, and names it where an assertion fails in the
/// same scope.
#define CELLIST_EACH_STORAGE(name)                                                                 \
    const cellist::Storage name =                                                                  \
        GENERATE(cellist::Storage::linked, cellist::Storage::counted, cellist::Storage::fixed);    \
    INFO("storage " << cellist::test::name_of(name))

}  // namespace cellist::test
