// SPDX-License-Identifier: MIT
#pragma once

#include "storage/partitions.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

/// Contiguous lists: two passes over the same kernels, count and fill. A single one where the
/// kernels put the records into partitions first, and the library moves them. An append counts and
/// fills: it moves the existing lists to their new places, and only new records are inserted.
class CountedStorage final : public ListStorage {
public:
    CountedStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);
    void clear() override;
    void start(const Kept& kept) override;
    void begin_pass() override;
    void insert(const PackedLists& copy) override;
    std::shared_ptr<const Memory> spare_memory(std::uint64_t bytes) const override;
    bool end_pass() override;
    bool review(BuildReport& report) override;
    void load(const PackedLists& copy, const Memory& offsets,
              const CellScan::Totals& totals) override;
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
    void set_partitions(std::shared_ptr<Partitions> partitions);
    [[nodiscard]] bool uses_partitions() const { return partitions_ && kept_.records == 0; }
    [[nodiscard]] Kernel& region_kernel(const char* name) const;
    void count_lists(const PackedLists& copy, const Memory& offsets);
    void move_lists(const PackedLists& copy);
    void plan_regions();
    void move_from_partitions();
    void move_from_regions();
    void trim_counts();
    bool review_partitions(BuildReport& report);
    void make_room(const BuildReport& report);
    PendingRead find(Findings& findings, const Memory& offsets);
    [[nodiscard]] cl_uint counts_at() const { return static_cast<cl_uint>(shape_.cells() + 1); }

    CellScan scan_;
    bool counted_ = false;      ///< the next pass fills
    bool has_counted_ = false;  ///< some build has
    Counters counting_;         ///< counters of the counting pass
    CellScan::Totals demand_;
    Findings filled_{
        {pool_.owner(), 1, sizeof(cellist_findings), "findings"}};  ///< of the filling pass
    std::shared_ptr<Partitions> partitions_;  ///< kept between builds; null where these count
    unsigned region_failures_ = 0;            ///< builds in a row that found a region full
    /// The capacity for which a partition had no room: smaller pools count.
    std::uint64_t partitions_failed_at_ = 0;
    cl_uint partitioned_ = 0;  ///< records of the last pass
};

}  // namespace cellist::detail
