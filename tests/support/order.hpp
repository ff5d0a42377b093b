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

/// A key in the order of the documentation: integers by value, floats -inf < ... < -0 < +0 < ... < +inf
/// < NaN. That is the total order of IEEE 754, but for its negative NaNs, which it has in front.
template <class T>
struct Ordered {
    T key;

    friend std::strong_ordering operator<=>(const Ordered& a, const Ordered& b) {
        if constexpr (std::is_floating_point_v<T>) {
            const auto is_last = [](T key) { return std::isnan(key) && std::signbit(key); };
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

/// Whether a record comes before another by a member or a function of the record.
template <class T>
auto before(auto key, Order order = Order::ascending) {
    return [key, order](const T& a, const T& b) {
        const auto x = ordered(std::invoke(key, a));
        const auto y = ordered(std::invoke(key, b));
        if (x != y) return order == Order::ascending ? x < y : y < x;
        return members(a) < members(b);
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

}  // namespace cellist::test
