// SPDX-License-Identifier: MIT
#include "storage/storage_counted.hpp"

#include <algorithm>

#include "cellist_kernels.hpp"
#include "device/preparation.hpp"

namespace cellist::detail {

namespace {

/// So many builds in a row that find a region full, and later builds of the same size count.
constexpr unsigned region_failures_most = 2;

}  // namespace

CountedStorage::CountedStorage(RecordKernels& kernels, const Shape& shape,
                               const ListsOptions& options)
    : ListStorage(
          kernels, shape, options, CELLIST_CONTIGUOUS,
          {.node_bytes = kernels.record().size, .head_words_a_cell = 2, .more_head_words = 1}),
      scan_(pool_.owner(), shape.cells(), counts_at()) {
    require_given(options.capacity_nodes.has_value(), "capacity_nodes");
    allocate_first(options.capacity_nodes.value_or(0));
    clear();
}

void CountedStorage::clear() {
    clear_words(0, 0, counts_at() + shape_.cells());
    expect_nothing();
}

void CountedStorage::add_to(Arguments& arguments, Inserts inserts) const {
    if (view_.mode != CELLIST_PARTITIONED) return ListStorage::add_to(arguments, inserts);
    const Partitions::Plan& plan = partitions_->plan();
    cellist_view partitioned = view(inserts);
    partitioned.pool_nodes = static_cast<cl_uint>(plan.nodes);
    // Blocks from one counter: those that are being filled lie close together.
    partitioned.shard_bits = 0;
    partitioned.thread_slots = plan.thread_slots;
    partitioned.partition_bits = plan.bits;
    ListStorage::add_to(arguments, partitions_->nodes(), partitions_->heads(), partitioned);
}

void CountedStorage::release_pool() noexcept {
    ListStorage::release_pool();
    set_partitions(nullptr);
}

/// These go when the pool grows: another capacity takes other partitions.
void CountedStorage::set_partitions(std::shared_ptr<Partitions> partitions) {
    partitions_ = std::move(partitions);
    pool_.set_replaceable_bytes(partitions_ ? partitions_->plan().bytes() : 0);
}

void CountedStorage::start(const Kept& kept) {
    ListStorage::start(kept);
    counted_ = false;
    if (kept.records > 0) return;
    if (Preparation::current() != nullptr && !has_counted_) return set_partitions(nullptr);
    if (partitions_ && partitions_->plan().records >= capacity_nodes()) return;
    set_partitions(nullptr);
    set_partitions(partitions_for_pool());
}

/// Partitions for the records that the pool has room for. Null where builds have to count.
std::unique_ptr<Partitions> CountedStorage::partitions_for_pool() const {
    if (options_.overflow != Overflow::grow || slice_.cells != shape_.cells() ||
        capacity_nodes() <= partitions_failed_at_)
        return nullptr;
    const auto plan = Partitions::plan(pool_.owner()->info, node_layout(record()).size,
                                       record().size, shape_.cells(), capacity_nodes());
    if (!plan || !pool_.has_room_for(plan->bytes())) return nullptr;
    return Partitions::make(pool_.owner(), *plan);
}

void CountedStorage::begin_pass() {
    if (uses_partitions()) {
        if (partitions_->plan().has_regions())
            plan_regions();
        else
            pool_.clear(partitions_->heads(), 0, 0, partitions_->plan().words_to_clear());
        view_.mode = CELLIST_PARTITIONED;
        return;
    }
    if (!counted_) {
        view_.mode = CELLIST_COUNTING;
        has_counted_ = true;
    }
    // insert() follows, and sets the counts and the counters.
    if (kept_.records > 0) return;
    if (counted_)
        clear_words(0, counts_at(), shape_.cells());
    else
        clear();
}

/// Makes the lists of a copy the first inserts, and in the filling pass the begin of the lists.
void CountedStorage::insert(const PackedLists& copy) {
    count_lists(copy, *copy.offsets);
    if (counted_) move_lists(copy);
}

void CountedStorage::load(const PackedLists& packed, const Memory& offsets,
                          const CellScan::Totals& totals) {
    reserve(totals.sum, totals.longest);
    copy(offsets, pool_.heads(), offsets.size_bytes());
    count_lists(packed, offsets);
    move_lists(packed);
    expected_ = std::make_shared<Expected>(Expected{totals.sum, totals.hash});
}

/// Enqueues counts that are the lengths of lists with these offsets, and clears the counters.
void CountedStorage::count_lists(const PackedLists& copy, const Memory& offsets) {
    Arguments arguments;
    add_to(arguments, Inserts::refused);
    add_contiguous_to(arguments, *copy.records, offsets);
    kernels_
        .get({{"append.cl", kernels::append_cl}}, "cellist_count_lists",
             mode() | CELLIST_CONTIGUOUS)
        .enqueue(Range::padded(std::max(shape_.cells(), pool_.counter_elements())), arguments);
}

/// Enqueues a copy of the lists of a copy to the begin of the lists, as far as these go.
void CountedStorage::move_lists(const PackedLists& copy) {
    Arguments arguments;
    add_to(arguments, Inserts::refused);
    add_contiguous_to(arguments, *copy.records, *copy.offsets);
    const std::uint64_t most = copy.records->size_bytes() / record().size;
    const bool is_alone = pool_.owner()->info.one_thread_per_work_group;
    kernels_.get({{"append.cl", kernels::append_cl}}, "cellist_move_lists", mode())
        .enqueue(
            Range::padded((most / CELLIST_MOVE_TILE + 1) * (is_alone ? 1 : CELLIST_MOVE_LANES)),
            arguments);
}

/// The partitions, which only builds use.
std::shared_ptr<const Memory> CountedStorage::spare_memory(std::uint64_t bytes) const {
    if (!partitions_ || partitions_->nodes().size_bytes() < bytes) return {};
    return {partitions_, &partitions_->nodes()};
}

bool CountedStorage::end_pass() {
    view_.mode = CELLIST_CONTIGUOUS;
    if (uses_partitions()) {
        move_from_partitions();
        reading_.add(partitions_->starts().read_later(&partitioned_, sizeof partitioned_));
        reading_.add(pool_.read(counters_));
        return false;
    }
    if (counted_) {
        // Nothing has changed the offsets yet, so they are compared with themselves.
        reading_.add(find(filled_, pool_.heads()));
        reading_.add(pool_.read(counters_));
        if (kept_.records > 0 && options_.overflow == Overflow::drop) trim_counts();
        return false;
    }
    scan_.sum(pool_.heads().cl(), CELLIST_NONE);
    reading_.add(scan_.read_later(demand_));
    reading_.add(pool_.read(counting_));
    if (options_.overflow != Overflow::drop) return false;
    // The pool is what it is: no need to look at the counts first.
    scan_.write_offsets(pool_.heads().cl(), pool_.heads().cl(), capacity_nodes(), kept_.offsets);
    counted_ = true;
    return true;
}

/// Makes the counts the lengths of the lists. An append that drops does not drop from the last
/// lists alone, so a validation could not tell the offsets from the counts.
void CountedStorage::trim_counts() {
    Arguments arguments;
    ListStorage::add_to(arguments);
    kernels_.get({{"append.cl", kernels::append_cl}}, "cellist_trim_counts", view_.mode)
        .enqueue(Range::padded(shape_.cells()), arguments);
    clear_words(0, 0, 0);
}

/// A kernel of regions.cl.
Kernel& CountedStorage::region_kernel(const char* name) const {
    const Partitions::Plan& plan = partitions_->plan();
    const std::size_t bytes = record().size;
    const auto define = [](const char* macro, std::uint64_t value) {
        return std::string("#define ") + macro + " " + std::to_string(value) + "u\n";
    };
    return kernels_.get({{"regions.cl", kernels::regions_cl}}, name, CELLIST_CONTIGUOUS,
                        define("CELLIST_REGION_CELLS", std::uint64_t{1} << plan.bits) +
                            define("CELLIST_REGION_RECORDS", plan.sorted_records) +
                            define("CELLIST_REGION_STAGED", plan.staged_records) +
                            define("CELLIST_RECORD_WORDS", bytes % 4 == 0 ? bytes / 4 : 0));
}

/// Enqueues the division of the partitions' memory into regions, by the lengths of the last lists.
void CountedStorage::plan_regions() {
    const Partitions::Plan& plan = partitions_->plan();
    pool_.clear(partitions_->heads(), 0, 0, 0);
    region_kernel("cellist_plan_regions")
        .run(Range::padded(plan.partitions), pool_.heads().cl(),
             static_cast<cl_uint>(shape_.cells()), plan.bits, plan.partitions,
             static_cast<cl_uint>(plan.nodes), plan.region_records_most(),
             partitions_->heads().cl());
}

/// Enqueues what turns regions into lists, if the pool has room for them.
void CountedStorage::move_from_regions() {
    const Partitions::Plan& plan = partitions_->plan();
    region_kernel("cellist_region_starts")
        .run(Range::padded(plan.partitions, CELLIST_REGION_SCAN_GROUP), partitions_->heads().cl(),
             plan.partitions, partitions_->starts().cl());
    Arguments arguments;
    ListStorage::add_to(arguments);
    arguments.add_nodes(partitions_->nodes(), record().name);
    arguments.add(partitions_->heads().cl());
    arguments.add(plan.bits);
    arguments.add(partitions_->starts().cl());
    region_kernel("cellist_move_region")
        .enqueue(Range::padded(std::size_t{plan.partitions} * CELLIST_REGION_GROUP,
                               CELLIST_REGION_GROUP),
                 arguments);
}

/// Enqueues what turns partitions into lists, if the pool has room for them.
void CountedStorage::move_from_partitions() {
    const Partitions::Plan& plan = partitions_->plan();
    if (plan.has_regions()) return move_from_regions();
    const KernelFile file{"partitions.cl", kernels::partitions_cl};
    kernels_.get({file}, "cellist_partition_starts", view_.mode)
        .run(1, partitions_->heads().cl(), plan.thread_slots, plan.partitions,
             partitions_->starts().cl());
    Arguments arguments;
    ListStorage::add_to(arguments);
    arguments.add_nodes(partitions_->nodes(), record().name);
    arguments.add(partitions_->heads().cl());
    arguments.add(plan.thread_slots);
    arguments.add(plan.bits);
    arguments.add(partitions_->starts().cl());
    kernels_.get({file}, "cellist_move_partition", view_.mode)
        .enqueue(Range(plan.partitions), arguments);
}

bool CountedStorage::review_partitions(BuildReport& report) {
    const Partitions::Plan plan = partitions_->plan();  // these may go
    const Counters::Sum inserted = counters_.sum();
    const std::uint64_t demand = partitioned_ + inserted.dropped;
    const std::uint64_t kept = std::min<std::uint64_t>(partitioned_, capacity_nodes());
    update(report, demand, kept, inserted.rejected);
    if (report.dropped == 0) {
        region_failures_ = 0;
        return true;
    }

    if (inserted.dropped == 0 && pool_.allows(pool_.bytes_with(demand) + plan.bytes())) {
        // All are in the partitions, and the pool is too small for them.
        pool_.require(demand, report);
        pool_.grow(demand, report);
        clear_words(0, 0, 0);
        move_from_partitions();
        update(report, demand, demand, inserted.rejected);
        return true;
    }
    set_partitions(nullptr);
    if (inserted.dropped > 0 && demand <= plan.records) {
        // A thread found no block, or a region was full: this build counts. The next build has
        // regions of other sizes.
        if (!plan.has_regions() || ++region_failures_ == region_failures_most)
            partitions_failed_at_ = plan.records;
        return false;
    }
    pool_.require(demand, report);
    pool_.grow(demand, report);
    set_partitions(partitions_for_pool());
    return false;
}

bool CountedStorage::review(BuildReport& report) {
    reading_.wait();
    if (uses_partitions()) return review_partitions(report);
    const Counters::Sum counting = counting_.sum();
    const std::uint64_t demand = demand_.sum + counting.dropped;
    const std::uint64_t kept = std::min<std::uint64_t>(demand_.sum, capacity_nodes());
    if (!counted_) {
        update(report, demand, kept, counting.rejected);
        make_room(report);
        counted_ = true;
        return false;
    }
    const Counters::Sum filled = counters_.sum();
    update(report, filled, kept);
    const std::uint64_t unfilled = filled_.found.unfilled;
    if (unfilled > 0 || filled.dropped != demand - kept || filled.rejected != counting.rejected)
        throw UnrepeatableError(
            "the kernel inserted " +
            std::to_string(kept - unfilled + filled.dropped + filled.rejected - kept_.records) +
            " records when it filled the lists, and " +
            std::to_string(demand + counting.rejected - kept_.records) +
            " or others when it counted them: it must insert the same records every time, "
            "or use Storage::linked");
    return true;
}

/// After the counting pass: room for all records, and the places of their lists.
void CountedStorage::make_room(const BuildReport& report) {
    if (report.dropped > 0) {
        const std::uint64_t demand = report.stored + report.dropped;
        pool_.require(demand, report);
        if (demand > demand_.sum)
            throw OverflowError("a list of more than " + std::to_string(CELLIST_CELL_COUNT_MAX) +
                                    " records is over the limit of Storage::counted",
                                report);
        pool_.grow(demand, report);
        // In an append, their memory may hold the copy of the lists, which lives until its end.
        if (!pool_.has_room_for(0)) set_partitions(nullptr);
    }
    scan_.write_offsets(pool_.heads().cl(), pool_.heads().cl(), capacity_nodes());
}

void CountedStorage::reset_passes() {
    counted_ = false;
    set_partitions(nullptr);
    view_.mode = CELLIST_CONTIGUOUS;
}

void CountedStorage::reserve(std::uint64_t total, std::uint64_t longest) {
    if (total > capacity_nodes()) set_partitions(nullptr);
    ListStorage::reserve(total, longest);
}

std::vector<cl_uint> CountedStorage::counts(BuildReport& report) {
    reading_.wait();
    const Counters::Sum counting = counting_.sum();
    update(report, demand_.sum + counting.dropped, 0, counting.rejected);
    auto words = host_memory<cl_uint>(pool_.heads().size_bytes() / sizeof(cl_uint));
    pool_.heads().read(words.data(), pool_.heads().size_bytes());
    words.erase(words.begin(), words.begin() + counts_at());
    return words;
}

/// Enqueues the comparison of the counts with the lists, and of the offsets with the expected
/// offsets.
PendingRead CountedStorage::find(Findings& findings, const Memory& offsets) {
    Arguments arguments;
    add_to(arguments, Inserts::refused);
    arguments.add(offsets.cl());
    return ListStorage::find(
        findings,
        kernels_.get({{"validate_contiguous.cl", kernels::validate_contiguous_cl}},
                     "cellist_validate_contiguous", view_.mode),
        arguments);
}

std::function<Validation()> CountedStorage::validate() {
    struct Check {
        Memory offsets;
        Findings findings;
        CellScan::Totals inserted;
        Counters counters;
        ReadbackFence done;
    };
    const auto check = std::make_shared<Check>();
    check->findings.memory = memory_for_findings();
    // Where the lists begin that have these counts.
    check->offsets =
        Memory(pool_.owner().state(), shape_.cells() + 1, sizeof(cl_uint), "validation buffer");
    scan_.sum(pool_.heads().cl(), CELLIST_NONE);
    scan_.write_offsets(pool_.heads().cl(), check->offsets.cl(), capacity_nodes());
    check->done.add(find(check->findings, check->offsets));
    check->done.add(scan_.read_later(check->inserted));
    check->done.add(pool_.read(check->counters));
    return [check, expected_of_build = expected_] {
        check->done.wait();
        // Sound lists that do not add up to what was stored have a wrong end; counts that do not
        // add up to what was stored and dropped are wrong.
        const cellist_findings& found = check->findings.found;
        const Counters::Sum counters = check->counters.sum();
        const std::uint64_t kept = expected_of_build->stored;
        const std::uint64_t lost = kept > found.nodes ? kept - found.nodes : found.nodes - kept;
        const std::uint64_t counted = check->inserted.sum + found.unfilled;
        const std::uint64_t expected = kept + counters.dropped;
        // Counts end at their limit, where what was dropped goes on.
        const bool wrong_counts = check->inserted.longest < CELLIST_CELL_COUNT_MAX
                                      ? counted != expected
                                      : counted > expected;
        return Validation{found.broken == 0 && wrong_counts ? std::uint64_t{1} : found.broken, 0,
                          found.unfilled + (found.broken == 0 ? lost : 0), counters.late,
                          bad_cell(found)};
    };
}

std::unique_ptr<ListStorage> make_counted(RecordKernels& kernels, const Shape& shape,
                                          const ListsOptions& options) {
    return std::make_unique<CountedStorage>(kernels, shape, options);
}

}  // namespace cellist::detail
