#include "sort_tuning.hpp"

#include <algorithm>
#include <bit>

#include "view.hpp"

namespace cellist::detail {

namespace {

/// Private memory for records that are sorted, and for those that are brought to the front of a list.
constexpr std::size_t moved_bytes_max = 65536;
constexpr std::size_t front_bytes_max = 4096;
constexpr std::uint32_t front_max = 64;

}  // namespace

std::size_t SortPlan::classes() const { return in_groups_ ? CELLIST_SORT_CLASSES - 1 : 1; }

SortTuning SortPlan::of_class(std::size_t index) const {
    if (!in_groups_) {
        if (linked_) return {.slots = 256, .width = 8, .items = 1, .team = 1, .lists = 32};
        return {.slots = slots_that_fit(256), .width = 8, .items = 1, .team = 1, .lists = 8};
    }
    const unsigned slots = CELLIST_SORT_CLASS_MIN << index;
    const unsigned width = slots > 32 || (linked_ && index == 0) ? 8 : 4;
    constexpr unsigned items = 128;
    const unsigned team = slots / width;
    return {.slots = slots, .width = width, .items = items, .team = team, .lists = items / team};
}

/// Records that one work-item copies to private memory.
unsigned SortPlan::slots_that_fit(unsigned most) const {
    const std::size_t fit = std::bit_floor(moved_bytes_max / record_bytes_);
    return static_cast<unsigned>(std::clamp<std::size_t>(fit, 8, most));
}

std::size_t SortPlan::class_for(std::uint64_t length) const {
    std::size_t index = 0;
    while (index + 1 < classes() && of_class(index).slots < length) ++index;
    return index;
}

SortTuning SortPlan::of_long_lists() const {
    if (in_groups_)
        return {.slots = 256, .width = 4, .items = 64, .team = 64, .lists = 1, .share = 2};
    return {.slots = slots_that_fit(128),
            .width = 8,
            .items = 1,
            .team = 1,
            .lists = 32,
            .share = 1024};
}

// On an EPYC under PoCL, the first 8 of 64 nodes are found in 0.8 times as long as the lists are sorted,
// 8 of 256 in a third, 8 of 4,096 in a sixth. On an H200, where short lists are sorted in local memory,
// it takes 0.8 to 5 times as long for lists of 64, and half as long for 16 of 1,024.
bool SortPlan::front_pays(std::uint32_t front, std::uint64_t mean) const {
    if (front > front_max || of_front(front).front * record_bytes_ > front_bytes_max) return false;
    return mean >= (in_groups_ ? 512 : 8 * std::uint64_t{front});
}

SortTuning SortPlan::of_front(std::uint32_t front) const {
    return {.slots = 8,
            .width = 8,
            .items = 1,
            .team = 1,
            .lists = !in_groups_ && linked_ ? 16u : 1u,
            .front = std::max(8u, std::bit_ceil(front))};
}

}  // namespace cellist::detail
