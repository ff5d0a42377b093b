// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cellist_kernels.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

namespace {

/// A head a cell and a pool of nodes with links; one pass.
class LinkedStorage final : public ListStorage {
public:
    LinkedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    bool can_mark() override { return can_save(pool_.counters()); }
    void mark() override;
    void return_to_mark() override;
    void begin_pass() override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    std::function<Validation()> validate() override;

private:
    void run(const char* name, const Range& range);
    void rewind();

    bool inserted_ = false;  ///< since mark()
};

constexpr std::uint64_t default_capacity_nodes = 65536;

}  // namespace

LinkedStorage::LinkedStorage(RecordKernels& kernels, const Shape& shape,
                             const ListsOptions& options)
    : ListStorage(kernels, shape, options, CELLIST_LINKED,
                  {.node_bytes = node_layout(kernels.record()).size,
                   .head_words_a_cell = 1,
                   .is_linked = true}) {
    require_given(options.capacity_nodes.has_value(), "capacity_nodes");
    std::uint64_t capacity =
        options.capacity_nodes.value_or(std::max(shape.cells(), default_capacity_nodes));
    if (!options.capacity_nodes && pool_.refusal(capacity)) capacity = 0;
    allocate_first(capacity);
    clear();
}

void LinkedStorage::clear() {
    clear_words(CELLIST_NONE, 0, shape_.cells());
    expect_nothing();
}

/// Inserts change only heads and counters, and the counters say which nodes are older.
void LinkedStorage::mark() {
    allocate_saved(pool_.counters());
    inserted_ = false;
    mark_ = *expected_;
}

/// Runs a kernel of append.cl that takes the saved counters.
void LinkedStorage::run(const char* name, const Range& range) {
    Arguments arguments;
    add_to(arguments);
    arguments.add(saved_.cl());
    kernels_.get({{"append.cl", kernels::append_cl}}, name, mode()).enqueue(range, arguments);
}

void LinkedStorage::rewind() {
    run("cellist_rewind_heads", Range::padded(shape_.cells()));
    copy(saved_, pool_.counters(), saved_.size_bytes());
}

void LinkedStorage::return_to_mark() {
    if (inserted_) rewind();
    expected_ = std::make_shared<Expected>(*mark_);
    mark_.reset();
}

void LinkedStorage::begin_pass() {
    if (!mark_) return clear();
    if (inserted_) rewind();
    run("cellist_save_counters", Range::padded(pool_.counter_elements()));
    inserted_ = true;
}

bool LinkedStorage::end_pass() {
    reading_.add(pool_.read(counters_));
    return false;
}

bool LinkedStorage::review(BuildReport& report) {
    const Counters::Sum counters = wait_for_counters();
    update(report, counters, counters.allocated);
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    const std::uint64_t demand = counters.allocated + counters.dropped;
    pool_.require(demand, report);
    // More appends may follow: each would move all records again.
    const std::uint64_t roomy = capacity_nodes() + capacity_nodes() / 2;
    pool_.grow(kept_.records > 0 && roomy > demand && !pool_.refusal(roomy) ? roomy : demand,
               report);
    return false;
}

std::function<Validation()> LinkedStorage::validate() {
    struct Check {
        Memory reached;
        Findings findings;
        Counters counters;
        ReadbackFence done;
    };
    const auto check = std::make_shared<Check>();
    constexpr cl_uint zero = 0;
    check->reached = Memory(pool_.owner().state(), (pool_.nodes_count() + 31) / 32, sizeof zero,
                            "validation buffer");
    check->findings.memory = memory_for_findings();
    check->reached.fill(&zero, sizeof zero, check->reached.size_bytes());
    Arguments arguments;
    add_to(arguments);
    arguments.add(check->reached.cl());
    Kernel& kernel = kernels_.get({{"validate_linked.cl", kernels::validate_linked_cl}},
                                  "cellist_validate_linked", mode());
    check->done.add(find(check->findings, kernel, arguments));
    check->done.add(pool_.read(check->counters));
    return [check, expected = expected_] {
        check->done.wait();
        const cellist_findings& found = check->findings.found;
        return Validation{found.broken, found.repeated,
                          expected->stored - std::min<std::uint64_t>(expected->stored, found.nodes),
                          check->counters.sum().late, bad_cell(found)};
    };
}

std::unique_ptr<ListStorage> make_linked(RecordKernels& kernels, const Shape& shape,
                                         const ListsOptions& options) {
    return std::make_unique<LinkedStorage>(kernels, shape, options);
}

}  // namespace cellist::detail
