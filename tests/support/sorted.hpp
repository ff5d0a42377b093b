// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "support/inserts.hpp"

namespace cellist::test {

inline constexpr std::array all_orders{Order::ascending, Order::descending};

constexpr std::string_view name_of(Order order) {
    return order == Order::ascending ? "ascending" : "descending";
}

/// A key in the order of the documentation: integers by value, floats -inf < ... < -0 < +0 < ... <
/// +inf < NaN. That is the total order of IEEE 754, but for its negative NaNs, which it has in
/// front.
template <class T>
struct Ordered {
    T key;

    friend std::strong_ordering operator<=>(const Ordered& a, const Ordered& b) {
        // Decides nearly always, in little time: tests are not optimised.
        if (a.key < b.key) return std::strong_ordering::less;
        if (b.key < a.key) return std::strong_ordering::greater;
        if constexpr (std::is_floating_point_v<T>) {
            const auto is_last = [](T value) { return std::isnan(value) && std::signbit(value); };
            if (is_last(a.key) != is_last(b.key)) return is_last(a.key) <=> is_last(b.key);
            return std::strong_order(a.key, b.key);
        } else {
            return a.key <=> b.key;
        }
    }
    friend bool operator==(const Ordered& a, const Ordered& b) { return (a <=> b) == 0; }
};

template <class T>
Ordered<T> ordered(T key) {
    return {key};
}

/// What decides between equal keys: the members, in order of declaration.
inline auto members(const Item& item) { return std::tuple(ordered(item.key), ordered(item.id)); }

inline bool by_key(const Item& a, const Item& b) {
    if (a.key < b.key) return true;
    if (b.key < a.key) return false;
    return members(a) < members(b);
}
inline bool by_id(const Item& a, const Item& b) { return a.id < b.id; }

/// Whether a record comes before another by a member or a function of the record.
template <class T>
auto before(auto key, Order order = Order::ascending) {
    return [key, order](const T& a, const T& b) {
        const std::strong_ordering found =
            ordered(std::invoke(key, a)) <=> ordered(std::invoke(key, b));
        if (found == 0) return members(a) < members(b);
        return order == Order::ascending ? found < 0 : found > 0;
    };
}

/// The lists that the inserts make, each in an order.
template <class T>
HostLists<T> sorted_lists(const Inserts<T>& inserts, std::uint64_t cells, auto comes_before) {
    std::vector<std::vector<T>> lists(cells);
    for (std::size_t i = 0; i < inserts.size(); ++i)
        if (inserts.cells[i] < cells) lists[inserts.cells[i]].push_back(inserts.records[i]);
    std::vector<std::uint64_t> offsets{0};
    std::vector<T> records;
    for (std::vector<T>& list : lists) {
        std::stable_sort(list.begin(), list.end(), comes_before);
        records.insert(records.end(), list.begin(), list.end());
        offsets.push_back(records.size());
    }
    return HostLists<T>({cells}, std::move(offsets), std::move(records));
}

/// Whether the records are the same bits, NaNs too. They have no padding.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
template <class T>
bool same_bits(const HostLists<T>& a, const HostLists<T>& b) {
    return a.offsets() == b.offsets() && same_bits(a.records(), b.records());
}

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
