// SPDX-License-Identifier: MIT
#include "sort/sort_tuning.hpp"

#include <algorithm>
#include <bit>

#include "device/view.hpp"

namespace cellist::detail {

namespace {

/// Private memory for records that are the top k of a list.
constexpr std::size_t top_k_bytes_max = 4096;
constexpr std::uint32_t top_k_max = 64;

/// Work-items that sort together, and the local memory that they take at most.
constexpr std::size_t items_max = 128;
constexpr std::size_t items_min = 64;
constexpr std::size_t local_bytes = 16384;

}  // namespace

SortPlan::SortPlan(cl_device_type type, const DeviceInfo& limits, bool linked,
                   std::size_t record_bytes)
    : items_(static_cast<unsigned>(
          std::min<std::size_t>(std::bit_floor(limits.max_work_group_size), items_max))),
      in_groups_((type & CL_DEVICE_TYPE_GPU) != 0 && items_ >= items_min &&
                 limits.local_memory_bytes >= local_bytes),
      linked_(linked),
      record_bytes_(record_bytes) {}

std::size_t SortPlan::classes() const { return in_groups_ ? CELLIST_SORT_CLASSES - 1 : 1; }

SortTuning SortPlan::of_class(std::size_t index) const {
    if (!in_groups_) {
        if (linked_) return {.chunk_size = 256, .width = 8, .items = 1, .team = 1, .lists = 32};
        return {.chunk_size = 256, .width = 8, .items = 1, .team = 1, .lists = 8};
    }
    const unsigned chunk_size = CELLIST_SORT_CLASS_MIN << index;
    const unsigned width = chunk_size > 32 || (linked_ && index == 0) ? 8 : 4;
    const unsigned team = chunk_size / width;
    return {.chunk_size = chunk_size,
            .width = width,
            .items = items_,
            .team = team,
            .lists = items_ / team};
}

std::size_t SortPlan::class_for(std::uint64_t length) const {
    std::size_t index = 0;
    while (index + 1 < classes() && of_class(index).chunk_size < length) ++index;
    return index;
}

SortTuning SortPlan::of_long_lists() const {
    if (in_groups_)
        return {
            .chunk_size = 256, .width = 4, .items = 64, .team = 64, .lists = 1, .merge_items = 2};
    return {.chunk_size = 128, .width = 8, .items = 1, .team = 1, .lists = 32, .merge_items = 1024};
}

// On an EPYC under PoCL, the first 8 of 64 nodes are found in 0.8 times as long as the lists are
// sorted, 8 of 256 in a third, 8 of 4,096 in a sixth. On an H200, where short lists are sorted in
// local memory, it takes 0.8 to 5 times as long for lists of 64, and half as long for 16 of 1,024.
bool SortPlan::top_k_is_faster(std::uint32_t top_k, std::uint64_t mean) const {
    if (top_k > top_k_max || of_top_k(top_k).top_k * record_bytes_ > top_k_bytes_max) return false;
    return mean >= (in_groups_ ? 512 : 8 * std::uint64_t{top_k});
}

SortTuning SortPlan::of_top_k(std::uint32_t top_k) const {
    return {.chunk_size = 8,
            .width = 8,
            .items = 1,
            .team = 1,
            .lists = !in_groups_ && linked_ ? 16u : 1u,
            .top_k = std::max(8u, std::bit_ceil(top_k))};
}

}  // namespace cellist::detail
