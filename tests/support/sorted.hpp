#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "support/inserts.hpp"

namespace cellist::test {

inline bool by_key(const Item& a, const Item& b) {
    return std::tie(a.key, a.id) < std::tie(b.key, b.id);
}
inline bool by_id(const Item& a, const Item& b) { return a.id < b.id; }

/// Requires that each cell holds the oracle's records in the order of `before`.
template <class T>
void require_sorted(const HostLists<T>& found, const Oracle<T>& oracle, auto before) {
    REQUIRE(found.records().size() == oracle.size());
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell) {
        std::vector<T> expected;
        const auto [begin, end] = oracle.equal_range(cell);
        for (auto entry = begin; entry != end; ++entry) expected.push_back(entry->second);
        std::sort(expected.begin(), expected.end(), before);
        const auto list = found.cell(cell);
        if (!std::equal(list.begin(), list.end(), expected.begin(), expected.end()))
            FAIL("cell " << cell << " is not sorted: " << list.size() << " records");
    }
}

}  // namespace cellist::test
