#pragma once

#include <iostream>

/// Prints what went wrong and fails the program.
inline void check(bool condition, const char* what) {
    if (condition) return;
    std::cerr << "failed: " << what << '\n';
    std::exit(1);
}
