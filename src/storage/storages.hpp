#pragma once

#include <optional>

#include "storage/cell_scan.hpp"
#include "storage/partitions.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

/// A head a cell and a pool of nodes with links; one pass.
class LinkedStorage final : public ListStorage {
public:
    LinkedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    std::function<Validation()> validate() override;
};

/// Contiguous lists: two passes over the same kernels, count and fill. A single one where the
/// kernels put the records into partitions first, and the library moves them.
class CountedStorage final : public ListStorage {
public:
    CountedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    void start() override;
    void begin_pass() override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    std::function<Validation()> validate() override;
    void reserve(std::uint64_t total, std::uint64_t longest) override;
    void add_to(Arguments& arguments, Inserts inserts) const override;
    void release_pool() noexcept override;

    /// What the counting pass counted: records of each cell, all of them dropped by the report.
    /// Follows end_pass(). Blocks.
    [[nodiscard]] std::vector<cl_uint> counts(BuildReport& report);

private:
    void reset_passes() override;

    [[nodiscard]] std::unique_ptr<Partitions> partitions_for_pool() const;
    void set_partitions(std::unique_ptr<Partitions> partitions);
    void move_from_partitions();
    bool review_partitions(BuildReport& report);
    void make_room(const BuildReport& report);
    PendingRead find(Findings& findings, const Memory& offsets);
    [[nodiscard]] cl_uint counts_at() const { return static_cast<cl_uint>(shape_.cells() + 1); }

    CellScan scan_;
    bool counted_ = false;  ///< the next pass fills
    Counters counting_;     ///< counters of the counting pass
    CellScan::Totals demand_;
    Findings filled_{
        {pool_.owner(), 1, sizeof(cellist_findings), "findings"}};  ///< of the filling pass
    std::unique_ptr<Partitions> partitions_;  ///< kept between builds; null where these count
    /// The capacity for which a thread found no block in the partitions: smaller pools count.
    std::uint64_t partitions_failed_at_ = 0;
    cl_uint partitioned_ = 0;  ///< records of the last pass
};

/// A number of slots for each cell; one pass.
class FixedStorage final : public ListStorage {
public:
    FixedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    std::function<Validation()> validate() override;
    void set_slice(const Slice& slice) override;
    std::uint64_t nodes_for(std::uint64_t total, std::uint64_t longest,
                            std::uint64_t cells) const override;
    void reserve(std::uint64_t total, std::uint64_t longest) override;

private:
    void reset_passes() override;

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

/// A number of slots for each cell, for the records that come first. Passes over the same kernels:
/// a threshold pass for a word of their keys, and a selection pass that fills the slots. The next
/// word follows where that leaves a tie.
class NearestStorage final : public ListStorage {
public:
    NearestStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    void start() override;
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
    CellScan::Totals kept_;
    cellist_selection selection_{};
    Memory selection_memory_;
};

}  // namespace cellist::detail
