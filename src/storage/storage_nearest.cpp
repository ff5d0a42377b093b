// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cellist_kernels.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

namespace {

/// A number of slots for each cell, for the records that come first. Passes over the same kernels:
/// a threshold pass for a word of their keys, and a selection pass that fills the slots. The next
/// word follows where that leaves a tie.
class NearestStorage final : public ListStorage {
public:
    NearestStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    void start(const Kept& kept) override;
    void begin_pass() override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    std::function<Validation()> validate() override;
    std::uint64_t nodes_for(std::uint64_t total, std::uint64_t longest,
                            std::uint64_t cells) const override;
    void reserve(std::uint64_t, std::uint64_t) override {}

private:
    void reset_passes() override;

    void prepare_threshold_pass();
    void run(const char* name, const Memory* selection = nullptr);
    [[nodiscard]] std::uint64_t row(std::uint64_t number) const { return number * shape_.cells(); }

    CellScan scan_;
    bool selecting_ = false;   ///< the next pass fills the slots
    Counters threshold_pass_;  ///< its counters
    CellScan::Totals in_slots_;
    cellist_selection selection_{};
    Memory selection_memory_;
};

/// Which member of a record the key is. Throws Error for the key of another record.
cl_uint member_index(const RecordType& record, const NearestKey& key) {
    if (key.record != record.name)
        throw Error(std::string("nearest() names a member of ") + key.record +
                    ", and the lists are of " + record.name);
    const auto member =
        std::find_if(record.members.begin(), record.members.end(),
                     [&](const RecordMember& candidate) { return candidate.name == key.member; });
    return static_cast<cl_uint>(member - record.members.begin());
}

/// No list outgrows its slots, so nothing grows, and a build that is reviewed may still change the
/// lists.
ListsOptions without_growth(ListsOptions options) {
    options.overflow = Overflow::stop;
    return options;
}

}  // namespace

NearestStorage::NearestStorage(RecordKernels& kernels, const Shape& shape,
                               const ListsOptions& options)
    : ListStorage(kernels, shape, without_growth(options), CELLIST_FIXED,
                  {.node_bytes = kernels.record().size,
                   // One row of thresholds: more come with the ties.
                   .head_words_a_cell = std::uint64_t{CELLIST_ROW_LEAST} +
                                        options.storage.nearest_key()->slots + 1}),
      scan_(pool_.owner(), shape.cells(), 0),
      selection_memory_(pool_.owner(), 1, sizeof selection_, "selection") {
    const NearestKey& key = *options.storage.nearest_key();
    view_.key_member = member_index(record(), key);
    allocate_first(std::uint64_t{key.slots} * shape.cells());
    view_.slots = key.slots;
    clear();
}

void NearestStorage::clear() {
    clear_words(0, 0, shape_.cells());
    expect_nothing();
}

void NearestStorage::start(const Kept& kept) {
    ListStorage::start(kept);
    selecting_ = false;
    view_.threshold_words = 0;
    pool_.fill_heads(view_.slots, row(CELLIST_ROW_REMAINING), shape_.cells());
}

void NearestStorage::begin_pass() {
    clear();
    if (!selecting_) {
        prepare_threshold_pass();
        view_.mode = CELLIST_THRESHOLD_PASS;
    } else {
        pool_.fill_heads(0, row(CELLIST_ROW_EQUALS), shape_.cells());
        view_.mode = CELLIST_SELECTION_PASS;
    }
}

/// Room for the thresholds of one more word, and no word among the least.
void NearestStorage::prepare_threshold_pass() {
    const std::uint64_t words = row(CELLIST_ROW_LEAST + view_.slots + view_.threshold_words + 1);
    const Memory& heads = pool_.heads();
    if (heads.size_bytes() < words * sizeof(cl_uint)) {
        const std::uint64_t more = words * sizeof(cl_uint) - heads.size_bytes();
        if (!pool_.has_room_for(more))
            throw MemoryError(
                std::string("records that are equal in ") + options_.storage.nearest_key()->member +
                " take another word of thresholds: " + std::to_string(bytes() + more) +
                " bytes in all, over the budget of " + std::to_string(options_.budget_bytes) +
                ": raise budget_bytes");
        Memory wider(pool_.owner(), words, sizeof(cl_uint), "head buffer");
        if (heads.size_bytes() > 0)
            opencl([&] {
                pool_.owner()->ordered_queue().enqueueCopyBuffer(heads.cl(), wider.cl(), 0, 0,
                                                                 heads.size_bytes());
            });
        pool_.replace_heads(std::move(wider));
    }
    pool_.fill_heads(CELLIST_NONE, row(CELLIST_ROW_LEAST), row(view_.slots));
}

/// Runs one of the kernels of nearest.cl over all cells.
void NearestStorage::run(const char* name, const Memory* selection) {
    Arguments arguments;
    add_to(arguments);
    if (selection != nullptr) arguments.add(selection->cl());
    kernels_.get({{"nearest.cl", kernels::nearest_cl}}, name, CELLIST_SELECTION_PASS)
        .enqueue(Range::padded(shape_.cells()), arguments);
}

bool NearestStorage::end_pass() {
    if (!selecting_) {
        reading_.add(pool_.read(threshold_pass_));
        view_.mode = CELLIST_SELECTION_PASS;
        run("cellist_set_thresholds");
        ++view_.threshold_words;
        selecting_ = true;
        view_.mode = CELLIST_FIXED;
        return true;
    }
    constexpr cl_uint zero = 0;
    selection_memory_.fill(&zero, sizeof zero, sizeof selection_);
    run("cellist_check_selection", &selection_memory_);
    view_.mode = CELLIST_FIXED;
    reading_.add(selection_memory_.read_later(&selection_, sizeof selection_));
    scan_.sum(pool_.heads().cl(), view_.slots);
    reading_.add(scan_.read_later(in_slots_));
    reading_.add(pool_.read(counters_));
    return false;
}

bool NearestStorage::review(BuildReport& report) {
    const Counters::Sum selected = wait_for_counters();
    update(report, selected, in_slots_.sum);
    expected_->counts_hash = in_slots_.hash;
    const Counters::Sum compared = threshold_pass_.sum();
    const std::uint64_t compared_records = compared.dropped + compared.rejected;
    if (selection_.unrepeated > 0 || compared.rejected != selected.rejected ||
        compared_records != report.attempted + kept_.records)
        throw UnrepeatableError("the kernel inserted " + std::to_string(report.attempted) +
                                " records when it filled the slots, and " +
                                std::to_string(compared_records - kept_.records) +
                                " or different ones when it compared them: it must insert the same "
                                "records every time, or use "
                                "another storage than nearest()");
    // Records that are equal in every word are the same: any of them will do.
    if (selection_.undecided == 0 || view_.threshold_words >= selection_.words) return true;
    selecting_ = false;
    return false;
}

void NearestStorage::reset_passes() {
    view_.mode = CELLIST_FIXED;
    selecting_ = false;
}

std::uint64_t NearestStorage::nodes_for(std::uint64_t, std::uint64_t, std::uint64_t cells) const {
    return view_.slots * cells;
}

std::function<Validation()> NearestStorage::validate() {
    struct Check {
        CellScan::Totals all;
        Counters counters;
        ReadbackFence done;
    };
    const auto check = std::make_shared<Check>();
    scan_.sum(pool_.heads().cl(), CELLIST_NONE);
    check->done.add(scan_.read_later(check->all));
    check->done.add(pool_.read(check->counters));
    return [check, expected = expected_, slots = view_.slots] {
        check->done.wait();
        // The counts are all that says which slots are in use.
        const std::uint64_t stored = check->all.sum;
        const bool sound = check->all.longest <= slots && check->all.hash == expected->counts_hash;
        return Validation{
            sound ? std::uint64_t{0} : std::uint64_t{1},
            0,
            stored > expected->stored ? stored - expected->stored : expected->stored - stored,
            check->counters.sum().late,
            {}};
    };
}

std::unique_ptr<ListStorage> make_nearest(RecordKernels& kernels, const Shape& shape,
                                          const ListsOptions& options) {
    return std::make_unique<NearestStorage>(kernels, shape, options);
}

}  // namespace cellist::detail
