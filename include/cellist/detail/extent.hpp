// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <utility>

#include <cellist/error.hpp>

namespace cellist::detail {

/// An extent or a coordinate, from any type of integer. Throws Error if it is negative.
struct Extent {
    std::uint64_t value;
    Extent(std::integral auto number)  // NOLINT(google-explicit-constructor)
        : value(static_cast<std::uint64_t>(number)) {
        if (std::cmp_less(number, 0))
            throw Error("an extent or coordinate of " + std::to_string(number) + " is negative");
    }
};

}  // namespace cellist::detail
