// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

#include "support/catch.hpp"

namespace cellist::test {

/// A generator whose seed is printed where an assertion fails in the same scope.
#define CELLIST_RANDOM(name, seed)                                                                 \
    std::mt19937 name(seed);                                                                       \
    INFO("seed of " #name ": " << (seed))

/// In 0 ... end - 1. Not a std::uniform_int_distribution: those differ between standard libraries.
inline std::uint32_t below(std::mt19937& random, std::uint32_t end) {
    return static_cast<std::uint32_t>(std::uint64_t{random()} * end >> 32);
}

/// Fisher-Yates, the same with every standard library.
template <class Range>
void shuffle(Range& range, std::mt19937& random) {
    for (std::size_t i = range.size(); i > 1; --i)
        std::swap(range[i - 1], range[below(random, static_cast<std::uint32_t>(i))]);
}

}  // namespace cellist::test
