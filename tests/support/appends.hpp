// SPDX-License-Identifier: MIT
#pragma once

#include "support/inserts.hpp"

namespace cellist::test {

/// Appends the inserts to the lists.
template <class T>
BuildReport append(Inserter<T>& inserter, Lists<T>& lists, const Inserts<T>& inserts) {
    return lists.append([&] { inserter.run(lists, inserts); });
}

/// What the lists hold.
template <class T>
Oracle<T> oracle_in(const Lists<T>& lists) {
    Oracle<T> oracle;
    const HostLists<T> found = lists.download();
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
        for (const T& record : found.cell(cell)) oracle.emplace(cell, record);
    return oracle;
}

/// Requires that a multiset of records by cell contains another.
template <class T>
void require_contains(const Oracle<T>& all, const Oracle<T>& some) {
    for (auto at = some.begin(); at != some.end(); at = some.upper_bound(at->first)) {
        const auto records_of = [&](const Oracle<T>& from) {
            std::vector<T> records;
            const auto [begin, end] = from.equal_range(at->first);
            for (auto entry = begin; entry != end; ++entry) records.push_back(entry->second);
            return sorted_bytes<T>(records);
        };
        const auto outer = records_of(all);
        const auto inner = records_of(some);
        REQUIRE(std::includes(outer.begin(), outer.end(), inner.begin(), inner.end()));
    }
}

}  // namespace cellist::test
