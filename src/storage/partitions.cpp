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

}  // namespace

std::uint64_t Partitions::Plan::words_to_clear() const {
    const std::uint64_t cursors = std::uint64_t{thread_slots} * partitions;
    return (thread_slots * sizeof(cl_ulong) + cursors * sizeof(cellist_cursor)) / sizeof(cl_uint);
}

std::uint64_t Partitions::Plan::head_words() const {
    return words_to_clear() + nodes / CELLIST_BLOCK_NODES;
}

std::uint64_t Partitions::Plan::bytes() const {
    return nodes * node_bytes + (head_words() + 1 + partitions) * sizeof(cl_uint);
}

std::optional<Partitions::Plan> Partitions::plan(const DeviceInfo& device, std::size_t node_bytes,
                                                 std::uint64_t cells, std::uint64_t records) {
    if (!device.one_thread_per_work_group) return {};
    Plan plan{.records = records + records / growth_part, .node_bytes = node_bytes};
    const std::uint64_t threads = std::max(device.compute_units, 1U);
    const std::uint64_t unfilled = threads * CELLIST_BLOCK_NODES;
    const std::uint64_t most = std::min(partitions_most, records / (unfilled_part * unfilled));
    // A thread moves a partition: there must be some for half of them.
    if (most < std::max<std::uint64_t>(threads / 2, 1) || (cells - 1) >> 31 >= most) return {};
    while ((cells - 1) >> plan.bits >= most) ++plan.bits;
    plan.partitions = static_cast<cl_uint>((cells - 1) >> plan.bits) + 1;
    plan.thread_slots = thread_slots_of(device);
    plan.nodes =
        (plan.records / CELLIST_BLOCK_NODES + 1) * CELLIST_BLOCK_NODES + plan.partitions * unfilled;
    if (plan.nodes > CELLIST_CAPACITY_NODES_MAX ||
        plan.nodes * node_bytes > device.max_allocation_bytes)
        return {};
    return plan;
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
