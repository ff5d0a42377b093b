#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

/// Which member of a record the key is. Throws Error for the key of another record.
cl_uint member_index(const RecordType& record, const NearestKey& key) {
    if (key.record != record.name)
        throw Error("nearest() names a member of " + key.record + ", and the lists are of " +
                    record.name);
    const auto member =
        std::find_if(record.members.begin(), record.members.end(),
                     [&](const RecordMember& candidate) { return candidate.name == key.member; });
    return static_cast<cl_uint>(member - record.members.begin());
}

/// No list outgrows its slots, so nothing grows, and a build that is reviewed may still change the lists.
ListsOptions without_growth(ListsOptions options) {
    options.overflow = Overflow::stop;
    return options;
}

}  // namespace

NearestStorage::NearestStorage(RecordKernels& kernels, const Shape& shape,
                               const ListsOptions& options)
    : ListStorage(kernels, shape, without_growth(options), CELLIST_FIXED, kernels.record().size,
                  // One row of thresholds: more come with the ties.
                  std::uint64_t{CELLIST_ROW_LEAST} + options.storage.nearest_key()->slots + 1),
      scan_(device_, shape.cells(), 0),
      selection_memory_(device_, 1, sizeof selection_, "selection") {
    const NearestKey& key = *options.storage.nearest_key();
    key_member_ = member_index(record(), key);
    const std::uint64_t capacity = std::uint64_t{key.slots} * shape.cells();
    if (const auto reason = refusal(capacity)) throw MemoryError(*reason);
    allocate_pool(capacity);
    slots_ = key.slots;
    clear();
}

void NearestStorage::clear() {
    clear_heads_and_counters(0, 0, shape_.cells());
    expect_nothing();
}

void NearestStorage::start() {
    ListStorage::start();
    selecting_ = false;
    threshold_words_ = 0;
    fill_heads(slots_, row(CELLIST_ROW_REMAINING), shape_.cells());
}

void NearestStorage::begin_pass() {
    clear();
    if (!selecting_) {
        prepare_threshold_pass();
        mode_ = CELLIST_THRESHOLD_PASS;
    } else {
        fill_heads(0, row(CELLIST_ROW_EQUALS), shape_.cells());
        mode_ = CELLIST_SELECTION_PASS;
    }
}

/// Room for the thresholds of one more word, and no word among the least.
void NearestStorage::prepare_threshold_pass() {
    const std::uint64_t words = row(CELLIST_ROW_LEAST + slots_ + threshold_words_ + 1);
    if (heads_.size_bytes() < words * sizeof(cl_uint)) {
        const std::uint64_t all = bytes() - heads_.size_bytes() + words * sizeof(cl_uint);
        if (all > options_.budget_bytes)
            throw MemoryError("records that are equal in " + options_.storage.nearest_key()->member +
                        " take another word of thresholds: " + std::to_string(all) +
                        " bytes in all, over the budget of " +
                        std::to_string(options_.budget_bytes) + ": raise budget_bytes");
        Memory heads(device_, words, sizeof(cl_uint), "head buffer");
        if (heads_.size_bytes() > 0)
            opencl([&] {
                device_->ordered_queue().enqueueCopyBuffer(heads_.cl(), heads.cl(), 0, 0,
                                                           heads_.size_bytes());
            });
        heads_ = std::move(heads);
    }
    fill_heads(CELLIST_NONE, row(CELLIST_ROW_LEAST), row(slots_));
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
        reading_ = read_counters(threshold_pass_);
        mode_ = CELLIST_SELECTION_PASS;
        run("cellist_set_thresholds");
        ++threshold_words_;
        selecting_ = true;
        mode_ = CELLIST_FIXED;
        return true;
    }
    constexpr cl_uint zero = 0;
    selection_memory_.fill(&zero, sizeof zero, sizeof selection_);
    run("cellist_check_selection", &selection_memory_);
    mode_ = CELLIST_FIXED;
    reading_ = selection_memory_.read_later(&selection_, sizeof selection_);
    scan_.sum(heads_.cl(), slots_);
    reading_ = scan_.read_later(kept_);
    reading_ = read_counters(counters_);
    return false;
}

bool NearestStorage::review(BuildReport& report) {
    reading_.wait();
    const Counters chosen = sum(counters_, 0);
    update(report, chosen, kept_.sum);
    expected_->counts_hash = kept_.hash;
    const Counters ranked = sum(threshold_pass_, 0);
    const std::uint64_t ranked_records = ranked.dropped + ranked.rejected;
    if (selection_.unrepeated > 0 || ranked.rejected != chosen.rejected ||
        ranked_records != report.attempted)
        throw UnrepeatableError("the kernel inserted " + std::to_string(report.attempted) +
                                " records when it filled the slots, and " +
                                std::to_string(ranked_records) +
                                " or different ones when it ranked them: it must insert the same "
                                "records every time, or use "
                                "another storage than nearest()");
    // Records that are equal in every word are the same: any of them will do.
    if (selection_.undecided == 0 || threshold_words_ >= selection_.words) return true;
    selecting_ = false;
    return false;
}

void NearestStorage::make_whole(bool) {
    mode_ = CELLIST_FIXED;
    selecting_ = false;
}

std::uint64_t NearestStorage::nodes_for(std::uint64_t, std::uint64_t, std::uint64_t cells) const {
    return slots_ * cells;
}

std::function<Validation()> NearestStorage::validate() {
    struct Check {
        CellScan::Totals all;
        Shards shards;
        ReadbackFence done;
    };
    const auto check = std::make_shared<Check>();
    scan_.sum(heads_.cl(), CELLIST_NONE);
    check->done = scan_.read_later(check->all);
    check->done = read_counters(check->shards);
    return [check, expected = expected_, slots = slots_] {
        check->done.wait();
        // The counts are all that says which slots are in use.
        const std::uint64_t stored = check->all.sum;
        const bool sound = check->all.longest <= slots && check->all.hash == expected->counts_hash;
        return Validation{
            sound ? std::uint64_t{0} : std::uint64_t{1},
            0,
            stored > expected->stored ? stored - expected->stored : expected->stored - stored,
            sum(check->shards, 0).late,
            {}};
    };
}

}  // namespace cellist::detail
