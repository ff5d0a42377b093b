#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

constexpr std::uint64_t default_capacity_nodes = 65536;

}  // namespace

LinkedStorage::LinkedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                             const Shape& shape, const ListsOptions& options)
    : ListStorage(std::move(device), definitions, shape, options, CELLIST_LINKED,
                  node_layout(definitions.records.back()).size, shape.cells()) {
    std::uint64_t capacity =
        options.capacity_nodes.value_or(std::max(shape.cells(), default_capacity_nodes));
    if (!options.capacity_nodes && refusal(capacity)) capacity = 0;
    if (const auto reason = refusal(capacity)) throw Error(*reason);
    allocate_pool(capacity);
    clear();
}

void LinkedStorage::clear() {
    fill_heads(CELLIST_NONE);
    clear_counters();
}

bool LinkedStorage::end_pass(BuildReport& report) {
    const Counters counters = read_counters();
    update(report, counters, counters.allocated);
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    const std::uint64_t demand = report.stored + report.dropped;
    require(demand, report);
    allocate_pool(demand);
    return false;
}

void LinkedStorage::recover(bool without_pool) {
    if (without_pool || !has_pool()) allocate_pool(0);
}

Validation LinkedStorage::validate() {
    constexpr cl_uint zero = 0;
    Memory reached(device_, (capacity_nodes_ + 31) / 32, sizeof(cl_uint), "validation buffer");
    reached.fill(&zero, sizeof zero, reached.size_bytes());
    if (!validate_)
        validate_.emplace(kernel("cellist_validate_linked", kernels::validate_linked_cl));
    Arguments arguments;
    add_to(arguments);
    arguments.add(reached.cl());
    const cellist_findings found = findings(*validate_, arguments);
    const Counters counters = read_counters();
    return {found.broken, found.repeated, counters.allocated - found.nodes, counters.late,
            bad_cell(found)};
}

}  // namespace cellist::detail
