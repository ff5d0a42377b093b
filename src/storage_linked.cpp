#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

constexpr std::uint64_t default_capacity_nodes = 65536;

/// What lies in the thread_slots of threads is at most this part of a pool; smaller pools have none.
constexpr std::uint64_t thread_blocks_part = 16;

}  // namespace

LinkedStorage::LinkedStorage(RecordKernels& kernels, const Shape& shape,
                             const ListsOptions& options)
    : ListStorage(kernels, shape, options, CELLIST_LINKED, node_layout(kernels.record()).size, 1) {
    std::uint64_t capacity =
        options.capacity_nodes.value_or(std::max(shape.cells(), default_capacity_nodes));
    if (!options.capacity_nodes && refusal(capacity)) capacity = 0;
    if (const auto reason = refusal(capacity)) throw MemoryError(*reason);
    allocate_pool(capacity);
    clear();
}

/// Where the pool does not grow it holds exactly what the options say: no thread may have free nodes for itself.
cl_uint LinkedStorage::thread_slots_with(std::uint64_t capacity_nodes) const {
    if (!device_->info.one_thread_per_work_group || options_.overflow != Overflow::grow) return 0;
    const cl_uint thread_slots = thread_slots_of(device_->info);
    const std::uint64_t nodes = std::uint64_t{thread_slots} * CELLIST_BLOCK_NODES;
    if (thread_blocks_part * nodes > capacity_nodes ||
        capacity_nodes > CELLIST_CAPACITY_NODES_MAX - nodes)
        return 0;
    // Nor where that would take more memory than there may be.
    const std::uint64_t pool_bytes = (capacity_nodes + nodes) * node_bytes_;
    const std::uint64_t counters =
        (1u << CELLIST_SHARD_BITS_MAX) + 1 + 2 * std::uint64_t{thread_slots};
    const bool fits = pool_bytes <= device_->info.max_allocation_bytes &&
                      heads_.size_bytes() + pool_bytes + counters * sizeof(cellist_shard) <=
                          options_.budget_bytes;
    return fits ? thread_slots : 0;
}

void LinkedStorage::clear() {
    clear_heads_and_counters(CELLIST_NONE, 0, shape_.cells());
    expect_nothing();
}

bool LinkedStorage::end_pass() {
    reading_ = read_counters(counters_);
    return false;
}

bool LinkedStorage::review(BuildReport& report) {
    reading_.wait();
    const Counters counters = sum(counters_, thread_slots_with(capacity_nodes_));
    update(report, counters, counters.allocated);
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    const std::uint64_t demand = counters.allocated + counters.dropped;
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
    if (options_.overflow == Overflow::grow && capacity_nodes_ < total) make_pool(total);
}

std::function<Validation()> LinkedStorage::validate() {
    struct Check {
        Memory reached;
        Findings findings;
        Shards shards;
        ReadbackFence done;
    };
    const auto check = std::make_shared<Check>();
    constexpr cl_uint zero = 0;
    check->reached =
        Memory(device_.state(), (pool_nodes() + 31) / 32, sizeof zero, "validation buffer");
    check->findings.memory = memory_for_findings();
    check->reached.fill(&zero, sizeof zero, check->reached.size_bytes());
    Arguments arguments;
    add_to(arguments);
    arguments.add(check->reached.cl());
    Kernel& kernel = kernels_.get({{"validate_linked.cl", kernels::validate_linked_cl}},
                                  "cellist_validate_linked", mode_);
    check->done = find(check->findings, kernel, arguments);
    check->done = read_counters(check->shards);
    return [check, expected = expected_, thread_slots = thread_slots_with(capacity_nodes_)] {
        check->done.wait();
        const cellist_findings& found = check->findings.found;
        return Validation{found.broken, found.repeated,
                          expected->stored - std::min<std::uint64_t>(expected->stored, found.nodes),
                          sum(check->shards, thread_slots).late, bad_cell(found)};
    };
}

}  // namespace cellist::detail
