// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace cellist::test {

/// Notes that the running test case, or a part of it, does not run here, and why. The program lists
/// these notes at its end. If no case of a program ran, it exits with `skipped_exit_code`.
void note_skip(const std::string& reason);

/// What ctest takes as skipped: see SKIP_RETURN_CODE.
inline constexpr int skipped_exit_code = 4;

}  // namespace cellist::test

/// Ends a test case that cannot run here: CELLIST_SKIP("the device has no doubles").
#define CELLIST_SKIP(reason)                                                                       \
    do {                                                                                           \
        cellist::test::note_skip(reason);                                                          \
        return;                                                                                    \
    } while (false)
