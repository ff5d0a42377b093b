#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

constexpr std::uint64_t default_capacity_nodes = 65536;

/// As cellist_findings in validate.cl.
struct Findings {
    cl_uint broken_links;
    cl_uint repeated_nodes;
    cl_uint reached_nodes;
    cl_uint first_bad_cell;
};

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
    constexpr cl_uint none = CELLIST_NONE;
    heads_.fill(&none, sizeof none, heads_.size_bytes());
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

void LinkedStorage::recover() {
    if (!has_pool()) allocate_pool(0);
}

Validation LinkedStorage::validate() {
    constexpr cl_uint zero = 0;
    Memory reached(device_, (capacity_nodes_ + 31) / 32, sizeof(cl_uint), "validation buffer");
    reached.fill(&zero, sizeof zero, reached.size_bytes());
    Findings findings{0, 0, 0, CELLIST_NONE};
    Memory device_findings(device_, 1, sizeof findings, "findings");
    device_findings.write(&findings, sizeof findings);

    if (!validate_) validate_.emplace(kernel("cellist_validate", kernels::validate_cl));
    Arguments arguments;
    add_to(arguments);
    arguments.add(reached.cl());
    arguments.add(device_findings.cl());
    validate_->enqueue(Range::padded(shape_.cells()), arguments);
    device_findings.read(&findings, sizeof findings);

    return {findings.broken_links, findings.repeated_nodes,
            read_counters().allocated - findings.reached_nodes, findings.first_bad_cell};
}

}  // namespace cellist::detail
