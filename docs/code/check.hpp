// SPDX-License-Identifier: MIT
#pragma once

#include <iostream>

/// Prints the failed check and ends the program with an error.
inline void check(bool condition, const char* what) {
    if (condition) return;
    std::cerr << "failed: " << what << '\n';
    std::exit(1);
}
