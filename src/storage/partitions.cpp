// SPDX-License-Identifier: MIT
#include "storage/partitions.hpp"

#include <algorithm>
#include <bit>

namespace cellist::detail {

namespace {

/// More than these, and their blocks do not stay in the caches while records are inserted.
constexpr std::uint64_t partitions_most = 512;

/// Blocks that threads have not filled are at most this part of the records.
constexpr std::uint64_t unfilled_part = 4;

/// Room for growth: this part of the records.
constexpr std::uint64_t growth_part = 8;

/// Of GPUs. More regions than these, and appending to them gets slower.
constexpr std::uint64_t regions_most = 1 << 15;
constexpr std::uint64_t region_cells_most = 2048;
/// Local memory for records of a region.
constexpr std::uint64_t staged_bytes_most = 24 << 10;
/// Records of a region in the registers of a work-item, and the words that they take.
constexpr std::uint64_t records_of_item_most = 9;
constexpr std::uint64_t words_of_item_most = 36;
/// Fewer records are counted.
constexpr std::uint64_t regions_records_least = 1 << 16;
/// A region without records has room for these.
constexpr std::uint64_t region_room = 64;
/// Room of a region at most, in multiples of the records that a work-group sorts. One work-group
/// moves them all.
constexpr std::uint64_t region_multiple_most = 16;

void set_bits(Partitions::Plan& plan, std::uint64_t cells, std::uint64_t most) {
    while ((cells - 1) >> plan.bits >= most) ++plan.bits;
    plan.partitions = static_cast<cl_uint>((cells - 1) >> plan.bits) + 1;
}

bool is_allowed(const Partitions::Plan& plan, const DeviceInfo& device) {
    return plan.nodes <= CELLIST_CAPACITY_NODES_MAX &&
           plan.nodes * plan.node_bytes <= device.max_allocation_bytes;
}

std::optional<Partitions::Plan> plan_regions(Partitions::Plan plan, const DeviceInfo& device,
                                             std::size_t record_bytes, std::uint64_t cells,
                                             std::uint64_t records) {
    constexpr std::uint64_t group = CELLIST_REGION_GROUP;
    constexpr std::uint64_t bytes =
        staged_bytes_most / 32 * 33 + (region_cells_most + group) * sizeof(cl_uint);
    if (records < regions_records_least || device.local_memory_bytes < bytes ||
        device.max_work_group_size < CELLIST_REGION_SCAN_GROUP)
        return {};
    const std::uint64_t words = (record_bytes + 3) / 4;
    plan.sorted_records = static_cast<cl_uint>(
        group * std::min(records_of_item_most, words_of_item_most / (words + 1)));
    plan.staged_records = static_cast<cl_uint>(staged_bytes_most / record_bytes / 32 * 32);
    if (plan.sorted_records == 0 || plan.staged_records == 0) return {};
    // Of a power of two of cells, the most that leaves a ninth of that room on average.
    const std::uint64_t least = std::max<std::uint64_t>(records / (plan.sorted_records / 9 * 8), 1);
    set_bits(plan, cells, std::clamp<std::uint64_t>(2 * least - 1, 1, regions_most));
    // A work-group moves a region: there must be enough of them, and none too large.
    if (plan.partitions < device.compute_units ||
        std::uint64_t{1} << plan.bits > region_cells_most ||
        records / plan.partitions > 4 * std::uint64_t{plan.sorted_records})
        return {};
    plan.nodes = plan.records + plan.records / growth_part + plan.partitions * region_room;
    return is_allowed(plan, device) ? std::optional(plan) : std::nullopt;
}

}  // namespace

cl_uint Partitions::Plan::region_records_most() const {
    return static_cast<cl_uint>(region_multiple_most * sorted_records);
}

std::uint64_t Partitions::Plan::words_to_clear() const {
    if (has_regions()) return 0;
    const std::uint64_t cursors = std::uint64_t{thread_slots} * partitions;
    return (thread_slots * sizeof(cl_ulong) + cursors * sizeof(cellist_cursor)) / sizeof(cl_uint);
}

std::uint64_t Partitions::Plan::head_words() const {
    if (has_regions()) return 1 + std::uint64_t{partitions} * (1 + CELLIST_REGION_COUNT_WORDS);
    return words_to_clear() + nodes / CELLIST_BLOCK_NODES;
}

std::uint64_t Partitions::Plan::bytes() const {
    return nodes * node_bytes + (head_words() + 1 + partitions) * sizeof(cl_uint);
}

std::optional<Partitions::Plan> Partitions::plan(const DeviceInfo& device, std::size_t node_bytes,
                                                 std::size_t record_bytes, std::uint64_t cells,
                                                 std::uint64_t records) {
    Plan plan{.records = records + records / growth_part, .node_bytes = node_bytes};
    if (device.is_gpu()) return plan_regions(plan, device, record_bytes, cells, records);
    if (!device.one_thread_per_work_group) return {};
    const std::uint64_t threads = std::max(device.compute_units, 1U);
    const std::uint64_t unfilled = threads * CELLIST_BLOCK_NODES;
    const std::uint64_t most = std::min(partitions_most, records / (unfilled_part * unfilled));
    // A thread moves a partition: there must be some for half of them.
    if (most < std::max<std::uint64_t>(threads / 2, 1) || (cells - 1) >> 31 >= most) return {};
    set_bits(plan, cells, most);
    plan.thread_slots = thread_slots_of(device);
    plan.nodes =
        (plan.records / CELLIST_BLOCK_NODES + 1) * CELLIST_BLOCK_NODES + plan.partitions * unfilled;
    return is_allowed(plan, device) ? std::optional(plan) : std::nullopt;
}

Partitions::Partitions(const MemoryOwner& device, const Plan& plan)
    : plan_(plan),
      nodes_(device, plan.nodes, plan.node_bytes, "partitions"),
      heads_(device, plan.head_words(), sizeof(cl_uint), "heads of partitions"),
      starts_(device, 1 + std::uint64_t{plan.partitions}, sizeof(cl_uint), "starts of partitions") {
}

std::unique_ptr<Partitions> Partitions::make(const MemoryOwner& device, const Plan& plan) {
    try {
        return std::unique_ptr<Partitions>(new Partitions(device, plan));
    } catch (const OpenClError& error) {
        if (!out_of_memory(error)) throw;
        return nullptr;
    }
}

}  // namespace cellist::detail
