// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>

#include <cellist/detail/extent.hpp>
#include <cellist/error.hpp>

namespace cellist {

/// The work-items of a launch, in 1 to 3 dimensions, x fastest. The kernel runs for exactly this
/// range; only padded() rounds a range up. A range with an extent of 0 launches nothing.
///
/// If `local` is 0, the library chooses a work-group of up to 256 items that divides the range. If
/// no useful size divides it (a prime extent, for example), the driver chooses. Such ranges are
/// slow on GPUs: pad them. Kernel::run throws Error if only some extents of `local` are 0.
struct Range {
    std::array<std::size_t, 3> global{1, 1, 1};
    std::array<std::size_t, 3> local{0, 0, 0};
    std::size_t dimensions = 1;

    /// These constructors throw Error if an extent is negative.
    Range(std::integral auto x) : Range(1, {x, 1, 1}) {}  // NOLINT(google-explicit-constructor)
    Range(std::integral auto x, std::integral auto y) : Range(2, {x, y, 1}) {}
    Range(std::integral auto x, std::integral auto y, std::integral auto z) : Range(3, {x, y, z}) {}

    /// Returns a range of at least `items` work-items, in whole work-groups of `group`. The kernel
    /// must return for the extra work-items: `if (get_global_id(0) >= count) return;`. Throws Error
    /// if an argument is negative, if `group` is 0, or if the sum exceeds 64 bits.
    [[nodiscard]] static Range padded(std::integral auto items, std::size_t group = 256) {
        Range range(items);
        std::size_t& count = range.global[0];
        if (group == 0 || count > ~std::size_t{0} - group)
            throw Error("no whole work-groups of " + std::to_string(group) + " hold " +
                        std::to_string(count) + " work-items");
        count = (count + group - 1) / group * group;
        range.local = {group, 1, 1};
        return range;
    }

private:
    Range(std::size_t count, const std::array<detail::Extent, 3>& extents)
        : global{extents[0].value, extents[1].value, extents[2].value}, dimensions(count) {}
};

}  // namespace cellist
