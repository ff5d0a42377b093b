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

/// The cells in a row, a plane and a volume of these extents.
inline void set_strides(const cl_uint (&extent)[4], cl_uint (&stride)[3]) {
    stride[0] = extent[0];
    for (std::size_t i = 1; i < std::size(stride); ++i) stride[i] = stride[i - 1] * extent[i];
}

/// The distribution of a container that one device has alone: each cell is its own.
inline cellist_distribution whole_distribution(const cellist_view& view) {
    cellist_distribution all{};
    all.domain = view;
    std::copy(std::begin(view.extent), std::end(view.extent), std::begin(all.block));
    std::copy(std::begin(view.extent), std::end(view.extent), std::begin(all.held));
    set_strides(view.extent, all.stride);
    set_strides(view.extent, all.held_stride);
    for (std::size_t i = 0; i < std::size(all.inverse); ++i)
        all.inverse[i] = static_cast<cl_uint>(
            std::min<cl_ulong>((cl_ulong{1} << 32) / std::max(all.stride[i], 1U), CELLIST_NONE));
    all.inserts = view.open_cells != 0 ? CELLIST_INSERT_OWN : 0;
    all.range_cells = view.cells;
    return all;
}

}  // namespace cellist::detail
