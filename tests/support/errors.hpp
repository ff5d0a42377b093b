// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <cellist/error.hpp>

#include "support/catch.hpp"

namespace cellist::test {

/// The E that `call` throws. The test fails if it throws none.
template <class E = Error>
E error_of(auto&& call) {
    std::optional<E> caught;
    try {
        call();
    } catch (const E& error) {
        caught = error;
    }
    REQUIRE(caught.has_value());
    return *caught;
}

inline bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

inline std::size_t count_of(std::string_view text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos;
         at = text.find(part, at + part.size()))
        ++count;
    return count;
}

}  // namespace cellist::test
