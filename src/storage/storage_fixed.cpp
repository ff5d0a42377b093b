// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cellist_kernels.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

namespace {

/// A number of slots for each cell; one pass.
class FixedStorage final : public ListStorage {
public:
    FixedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    bool can_mark() override { return can_save(pool_.heads()); }
    void mark() override;
    void return_to_mark() override;
    void begin_pass() override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    std::function<Validation()> validate() override;
    void set_slice(const Slice& slice) override;
    std::uint64_t nodes_for(std::uint64_t total, std::uint64_t longest,
                            std::uint64_t cells) const override;
    void reserve(std::uint64_t total, std::uint64_t longest) override;

private:
    void reset_passes() override;
    void rewind();

    /// Replaces the pool by one for `slots`; `allocate` takes its number of nodes. There are no
    /// slots if it throws.
    template <class Allocate>
    void set_slots(std::uint64_t slots, const Allocate& allocate) {
        view_.slots = 0;
        allocate(nodes_with(slots));
        view_.slots = static_cast<cl_uint>(slots);
    }
    [[nodiscard]] std::uint64_t nodes_with(std::uint64_t slots) const;

    CellScan scan_;
    CellScan::Totals in_slots_;  ///< of the last pass: records in slots, longest list
};

}  // namespace

FixedStorage::FixedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options)
    : ListStorage(kernels, shape, options, CELLIST_FIXED,
                  {.node_bytes = kernels.record().size, .head_words_a_cell = 1}),
      scan_(pool_.owner(), shape.cells(), 0) {
    require_given(options.slots.has_value(), "slots in Storage::fixed");
    std::uint64_t slots = options.slots.value_or(4);
    if (!options.slots && pool_.refusal(nodes_with(slots))) slots = 0;
    allocate_first(nodes_with(slots));
    view_.slots = static_cast<cl_uint>(slots);
    clear();
}

/// Nodes of all cells of the slice together; more than any device has where the product exceeds 64
/// bits.
std::uint64_t FixedStorage::nodes_with(std::uint64_t slots) const {
    if (slots > CELLIST_CAPACITY_NODES_MAX) return ~std::uint64_t{0} / pool_.node_bytes();
    return slots * slice_.cells;
}

void FixedStorage::clear() {
    clear_words(0, 0, shape_.cells());
    expect_nothing();
}

/// Inserts change only counts. Those of dropped records do not stay.
void FixedStorage::mark() {
    allocate_saved(pool_.heads());
    copy(pool_.heads(), saved_, saved_.size_bytes());
    Arguments arguments;
    add_to(arguments, pool_.nodes(), saved_, view(Inserts::refused));
    kernels_.get({{"append.cl", kernels::append_cl}}, "cellist_trim_counts", mode())
        .enqueue(Range::padded(shape_.cells()), arguments);
    mark_ = *expected_;
}

void FixedStorage::rewind() {
    copy(saved_, pool_.heads(), saved_.size_bytes());
    clear_words(0, 0, 0);
}

void FixedStorage::return_to_mark() {
    rewind();
    scan_.sum(pool_.heads().cl(), CELLIST_NONE);
    CellScan::Totals totals;
    ReadbackFence reading;
    reading.add(scan_.read_later(totals));
    reading.wait();
    expected_ = std::make_shared<Expected>(Expected{mark_->stored, totals.hash});
    mark_.reset();
}

void FixedStorage::begin_pass() {
    if (!mark_) return clear();
    rewind();
}

bool FixedStorage::end_pass() {
    scan_.sum(pool_.heads().cl(), view_.slots);
    reading_.add(scan_.read_later(in_slots_));
    reading_.add(pool_.read(counters_));
    return false;
}

bool FixedStorage::review(BuildReport& report) {
    const Counters::Sum counters = wait_for_counters();
    update(report, counters, in_slots_.sum);
    expected_->counts_hash = in_slots_.hash;
    if (counters.dropped == 0 || options_.overflow == Overflow::drop) return true;

    const std::uint64_t longest = in_slots_.longest;
    if (options_.overflow == Overflow::stop)
        throw OverflowError(
            std::to_string(view_.slots) + " slots for each cell are too few for a list of " +
                std::to_string(longest) + " records: raise slots or use Overflow::grow",
            report);
    if (const auto reason = pool_.refusal(nodes_with(longest)))
        throw OverflowError("the longest list has " + std::to_string(longest) +
                                " records, and so many slots for each of " +
                                std::to_string(slice_.cells) +
                                " cells are too many (use Storage::linked or counted): " + *reason,
                            report);
    // More appends may follow: each would move all records again.
    const std::uint64_t roomy = view_.slots + view_.slots / 2;
    const bool grows_by_half =
        kept_.records > 0 && roomy > longest && !pool_.refusal(nodes_with(roomy));
    set_slots(grows_by_half ? roomy : longest,
              [&](std::uint64_t nodes) { pool_.grow(nodes, report); });
    return false;
}

void FixedStorage::reset_passes() {
    if (capacity_nodes() < nodes_with(view_.slots))
        set_slots(0, [&](std::uint64_t nodes) { pool_.allocate(nodes); });
}

void FixedStorage::set_slice(const Slice& slice) {
    ListStorage::set_slice(slice);
    if (capacity_nodes() < nodes_with(view_.slots)) view_.slots = 0;
}

std::uint64_t FixedStorage::nodes_for(std::uint64_t, std::uint64_t longest,
                                      std::uint64_t cells) const {
    return (options_.overflow == Overflow::grow ? longest : view_.slots) * cells;
}

void FixedStorage::reserve(std::uint64_t, std::uint64_t longest) {
    if (options_.overflow != Overflow::grow || view_.slots >= longest) return;
    set_slots(longest, [&](std::uint64_t nodes) { pool_.allocate_for_slice(nodes, slice_.cells); });
}

std::function<Validation()> FixedStorage::validate() {
    struct Check {
        CellScan::Totals in_slots, all;
        Counters counters;
        ReadbackFence done;
    };
    const auto check = std::make_shared<Check>();
    scan_.sum(pool_.heads().cl(), view_.slots);
    check->done.add(scan_.read_later(check->in_slots));
    scan_.sum(pool_.heads().cl(), CELLIST_NONE);
    check->done.add(scan_.read_later(check->all));
    check->done.add(pool_.read(check->counters));
    return [check, expected = expected_] {
        check->done.wait();
        // The counts are all that says which slots are in use: they must be those of the build, and
        // add up to what was stored and to what was dropped.
        const std::uint64_t stored = check->in_slots.sum;
        const std::uint64_t lost =
            stored > expected->stored ? stored - expected->stored : expected->stored - stored;
        const std::uint64_t over = check->all.sum - stored;
        const Counters::Sum counters = check->counters.sum();
        // Counts end at their limit, where what was dropped goes on.
        const bool adds_up = check->all.longest < CELLIST_CELL_COUNT_MAX ? over == counters.dropped
                                                                         : over <= counters.dropped;
        const bool sound = adds_up && check->all.hash == expected->counts_hash;
        return Validation{sound ? std::uint64_t{0} : std::uint64_t{1}, 0, lost, counters.late, {}};
    };
}

std::unique_ptr<ListStorage> make_fixed(RecordKernels& kernels, const Shape& shape,
                                        const ListsOptions& options) {
    return std::make_unique<FixedStorage>(kernels, shape, options);
}

}  // namespace cellist::detail
