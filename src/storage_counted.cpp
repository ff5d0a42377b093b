#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

CountedStorage::CountedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                               const Shape& shape, const ListsOptions& options)
    : ListStorage(std::move(device), definitions, shape, options, CELLIST_CONTIGUOUS,
                  definitions.records.back().size, 2 * shape.cells() + 1),
      scan_(device_, shape.cells(), counts_at()) {
    const std::uint64_t capacity = options.capacity_nodes.value_or(0);
    if (const auto reason = refusal(capacity)) throw Error(*reason);
    allocate_pool(capacity);
    clear();
}

void CountedStorage::clear() {
    fill_heads(0);
    clear_counters();
    kept_ = 0;
}

void CountedStorage::begin_pass() {
    if (!counted_) {
        clear();
        mode_ = CELLIST_COUNTING;
    } else {
        fill_heads(0, counts_at());
        clear_counters();
    }
}

bool CountedStorage::end_pass(BuildReport& report) {
    mode_ = CELLIST_CONTIGUOUS;
    const Counters counters = read_counters();
    if (!counted_) {
        counters_ = counters;
        place_lists(report);
        counted_ = true;
        return false;
    }
    update(report, counters, kept_);
    check_repeats(counters);
    return true;
}

/// After the counting pass: makes room for all records, or decides which cells go short.
void CountedStorage::place_lists(BuildReport& report) {
    const CellScan::Sums sums = scan_.sums(heads_.cl(), CELLIST_NONE);
    demand_ = sums.total + counters_.dropped;
    kept_ = std::min(sums.total, capacity_nodes_);
    update(report, counters_, kept_);
    report.dropped = demand_ - kept_;
    report.attempted = demand_ + counters_.rejected;
    if (kept_ < demand_ && options_.overflow != Overflow::drop) {
        require(demand_, report);
        if (counters_.dropped > 0)
            throw OverflowError("a list of more than " + std::to_string(CELLIST_CELL_COUNT_MAX) +
                                    " records is over the limit of Storage::counted",
                                report);
        allocate_pool(demand_);
        kept_ = demand_;
    }
    scan_.write_offsets(heads_.cl(), sums, capacity_nodes_);
}

void CountedStorage::check_repeats(const Counters& filled) {
    const std::uint64_t unfilled = validate().lost_nodes;
    if (unfilled == 0 && filled.dropped == demand_ - kept_ && filled.rejected == counters_.rejected)
        return;
    throw Error(
        "the kernel inserted " +
        std::to_string(kept_ - unfilled + filled.dropped + filled.rejected) +
        " records when it filled the lists, and " + std::to_string(demand_ + counters_.rejected) +
        " or others when it counted them: it must insert the same records every time, or use "
        "Storage::linked");
}

Validation CountedStorage::validate() {
    if (!validate_)
        validate_.emplace(kernel("cellist_validate_contiguous", kernels::validate_contiguous_cl));
    Arguments arguments;
    add_to(arguments);
    const cellist_findings found = findings(*validate_, arguments);
    // Sound lists that do not add up to what was stored have a wrong end; counts that do not add up to
    // what was stored and dropped are wrong.
    const std::uint64_t missing = kept_ > found.nodes ? kept_ - found.nodes : found.nodes - kept_;
    const CellScan::Sums inserted = scan_.sums(heads_.cl(), CELLIST_NONE);
    const std::uint64_t counted = inserted.total + found.unfilled;
    const Counters counters = read_counters();
    const std::uint64_t expected = kept_ + counters.dropped;
    // Counts end at their limit, where what was dropped goes on.
    const bool wrong_counts =
        inserted.longest < CELLIST_CELL_COUNT_MAX ? counted != expected : counted > expected;
    return {found.broken == 0 && wrong_counts ? std::uint64_t{1} : found.broken, 0,
            found.unfilled + (found.broken == 0 ? missing : 0), counters.late, bad_cell(found)};
}

void CountedStorage::recover(bool without_pool) {
    counted_ = false;
    mode_ = CELLIST_CONTIGUOUS;
    if (without_pool || !has_pool()) allocate_pool(0);
}

}  // namespace cellist::detail
