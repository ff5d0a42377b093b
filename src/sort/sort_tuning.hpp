// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

#include <cellist/device.hpp>

namespace cellist::detail {

/// How the work of a sort is divided among work-items; see kernels/sort.cl.
struct SortTuning {
    unsigned chunk_size;  ///< records that are ranked together
    unsigned width;       ///< records that a work-item ranks at once
    unsigned items;       ///< work-items that sort together
    unsigned team;        ///< work-items that sort a list
    unsigned lists;  ///< lists that `items` sort, or segments of lists that a work-item traverses
    unsigned merge_items = 1;  ///< nodes that a work-item merges
    unsigned top_k = 1;        ///< most first records that a work-item finds

    friend auto operator<=>(const SortTuning&, const SortTuning&) = default;
};

/// What is best for a type of device and a kind of node. GPUs sort a list with several work-items
/// that share local memory, and have a class for each power of two of its length from 16 to 256.
/// Elsewhere one work-item sorts several lists, and there is one class.
class SortPlan {
public:
    /// As on a device of a type with the limits of this one.
    SortPlan(cl_device_type type, const DeviceInfo& limits, bool linked, std::size_t record_bytes);

    [[nodiscard]] bool in_groups() const { return in_groups_; }
    /// Classes of lists that are ranked; longer lists are merged.
    [[nodiscard]] std::size_t classes() const;
    [[nodiscard]] SortTuning of_class(std::size_t index) const;
    /// The class that lists of `length` nodes belong to: the last one if none has room for them.
    [[nodiscard]] std::size_t class_for(std::uint64_t length) const;
    [[nodiscard]] SortTuning of_long_lists() const;

    /// Whether finding the top k of lists of `mean` nodes takes less time than sorting the lists.
    [[nodiscard]] bool top_k_is_faster(std::uint32_t top_k, std::uint64_t mean) const;
    [[nodiscard]] SortTuning of_top_k(std::uint32_t top_k) const;

private:
    unsigned items_;  ///< of a work-group
    bool in_groups_;
    bool linked_;
    std::size_t record_bytes_;
};

}  // namespace cellist::detail
