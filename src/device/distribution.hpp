// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <iterator>

#include <cellist/detail/arguments.hpp>

#include "device/view.hpp"

namespace cellist::detail {

/// The type of the last parameter of a container in programs with a distributed one.
inline constexpr auto distribution_type = "cellist_distribution";

inline void add_distribution(Arguments& arguments, const cellist_distribution& distribution) {
    arguments.append(Arguments::Kind::value, &distribution, sizeof distribution);
    arguments.set_type(distribution_type);
}

/// 2^32 / extent as cellist_divide takes it.
inline cl_uint inverse_of(cl_uint extent) {
    return static_cast<cl_uint>(
        std::min<cl_ulong>((cl_ulong{1} << 32) / std::max(extent, 1U), CELLIST_NONE));
}

/// The distribution of a container that one device has alone: each cell is its own.
inline cellist_distribution whole_distribution(const cellist_view& view) {
    cellist_distribution all{};
    all.domain = view;
    std::copy(std::begin(view.extent), std::end(view.extent), std::begin(all.block));
    std::copy(std::begin(view.extent), std::end(view.extent), std::begin(all.held));
    for (std::size_t i = 0; i < std::size(all.inverse); ++i)
        all.inverse[i] = inverse_of(view.extent[i]);
    all.inserts = view.open_cells != 0 ? CELLIST_INSERT_OWN : 0;
    all.range_cells = view.cells;
    return all;
}

}  // namespace cellist::detail
