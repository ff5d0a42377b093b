#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

FixedStorage::FixedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                           const Shape& shape, const ListsOptions& options)
    : ListStorage(std::move(device), definitions, shape, options, CELLIST_FIXED,
                  definitions.records.back().size, shape.cells()),
      scan_(device_, shape.cells(), 0) {
    std::uint64_t slots = options.slots.value_or(4);
    if (!options.slots && refusal(nodes_with(slots))) slots = 0;
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
    fill_heads(0);
    clear_counters();
    stored_ = 0;
}

bool FixedStorage::end_pass(BuildReport& report) {
    const Counters counters = read_counters();
    const CellScan::Sums sums = scan_.sums(heads_.cl(), slots_);
    stored_ = sums.total;
    update(report, counters, sums.total);
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    if (options_.overflow == Overflow::stop)
        throw OverflowError(
            std::to_string(slots_) + " slots for each cell are too few for a list of " +
                std::to_string(sums.longest) + " records: raise slots or use Overflow::grow",
            report);
    if (const auto reason = refusal(nodes_with(sums.longest)))
        throw OverflowError("the longest list has " + std::to_string(sums.longest) +
                                " records, and so many slots for each of " +
                                std::to_string(shape_.cells()) +
                                " cells are too many (use Storage::linked or counted): " + *reason,
                            report);
    set_slots(sums.longest);
    return false;
}

void FixedStorage::recover(bool without_pool) {
    if (without_pool || !has_pool()) set_slots(0);
}

Validation FixedStorage::validate() {
    // The counts are all that says which slots are in use: they must add up to what was stored and
    // to what was dropped.
    const std::uint64_t stored = scan_.sums(heads_.cl(), slots_).total;
    const CellScan::Sums demand = scan_.sums(heads_.cl(), CELLIST_NONE);
    const std::uint64_t lost = stored > stored_ ? stored - stored_ : stored_ - stored;
    const std::uint64_t over = demand.total - stored;
    const Counters counters = read_counters();
    // Counts end at their limit, where what was dropped goes on.
    const bool sound = demand.longest < CELLIST_CELL_COUNT_MAX ? over == counters.dropped
                                                               : over <= counters.dropped;
    return {sound ? std::uint64_t{0} : std::uint64_t{1}, 0, lost, counters.late, {}};
}

}  // namespace cellist::detail
