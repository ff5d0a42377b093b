#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

FixedStorage::FixedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                           const Shape& shape, const ListsOptions& options)
    : ListStorage(std::move(device), definitions, shape, options, CELLIST_FIXED,
                  definitions.records.back().size, shape.cells()),
      scan_(device_, shape.cells(), 0) {
    const std::uint64_t slots = options.slots.value_or(4);
    if (const auto reason = refusal(nodes_with(slots))) throw Error(*reason);
    set_slots(slots);
    clear();
}

/// Nodes of all cells together; more than any device has where the product exceeds 64 bits.
std::uint64_t FixedStorage::nodes_with(std::uint64_t slots) const {
    if (slots > CELLIST_CAPACITY_NODES_MAX) return ~std::uint64_t{0} / node_bytes_;
    return slots * shape_.cells();
}

void FixedStorage::set_slots(std::uint64_t slots) {
    slots_ = 0;
    allocate_pool(nodes_with(slots));
    slots_ = static_cast<cl_uint>(slots);
}

void FixedStorage::clear() {
    constexpr cl_uint zero = 0;
    heads_.fill(&zero, sizeof zero, heads_.size_bytes());
    clear_counters();
}

bool FixedStorage::end_pass(BuildReport& report) {
    const Counters counters = read_counters();
    const CellScan::Sums sums = scan_.sums(heads_.cl(), slots_);
    update(report, counters, sums.total);
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    if (options_.overflow == Overflow::stop)
        throw OverflowError(
            std::to_string(slots_) + " slots for each cell are too few for a list of " +
                std::to_string(sums.longest) + " records: raise slots or use Overflow::grow",
            report);
    require(nodes_with(sums.longest), report);
    set_slots(sums.longest);
    return false;
}

void FixedStorage::recover() {
    if (!has_pool()) set_slots(0);
}

Validation FixedStorage::validate() {
    // The counts say what every list holds; what they say was dropped was counted when it was.
    const std::uint64_t demand = scan_.sums(heads_.cl(), CELLIST_NONE).total;
    const std::uint64_t stored = scan_.sums(heads_.cl(), slots_).total;
    const std::uint64_t dropped = read_counters().dropped;
    return {0, 0, demand - stored == dropped ? 0 : std::max(demand - stored, dropped), 0};
}

}  // namespace cellist::detail
