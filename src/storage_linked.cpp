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
    stored_ = 0;
}

bool LinkedStorage::finish_pass() {
    reading_ = read_counters(counters_);
    return false;
}

bool LinkedStorage::review_pass(BuildReport& report) {
    const Counters counters = sum(counters_);
    update(report, counters, counters.allocated);
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    const std::uint64_t demand = report.stored + report.dropped;
    require(demand, report);
    grow_pool(demand, report);
    return false;
}

void LinkedStorage::make_whole(bool without_pool) {
    if (empties_pool(without_pool)) allocate_pool(0);
}

std::uint64_t LinkedStorage::nodes_for(std::uint64_t total, std::uint64_t, std::uint64_t) const {
    return total;
}

void LinkedStorage::reserve(std::uint64_t total, std::uint64_t) {
    if (options_.overflow == Overflow::grow && capacity_nodes_ < total) allocate_pool(total);
}

std::function<Validation()> LinkedStorage::validate() {
    struct Check {
        Memory reached;
        Findings findings;
        Shards shards;
        Arrival done;
    };
    const auto check = std::make_shared<Check>();
    constexpr cl_uint zero = 0;
    check->reached = Memory(device_, (capacity_nodes_ + 31) / 32, sizeof zero, "validation buffer");
    check->reached.fill(&zero, sizeof zero, check->reached.size_bytes());
    if (!validate_)
        validate_.emplace(kernel("cellist_validate_linked", kernels::validate_linked_cl, mode_));
    Arguments arguments;
    add_to(arguments);
    arguments.add(check->reached.cl());
    check->done = find(check->findings, *validate_, arguments);
    check->done = read_counters(check->shards);
    return [check] {
        check->done.wait();
        const cellist_findings& found = check->findings.found;
        const Counters counters = sum(check->shards);
        return Validation{found.broken, found.repeated, counters.allocated - found.nodes,
                          counters.late, bad_cell(found)};
    };
}

}  // namespace cellist::detail
