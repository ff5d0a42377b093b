// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

#include "device/record_kernels.hpp"
#include "device/view.hpp"
#include "storage/cell_scan.hpp"
#include "storage/node_pool.hpp"

namespace cellist::detail {

/// The kernel did not insert the same records again where that is needed.
class UnrepeatableError : public Error {
public:
    using Error::Error;
};

/// Whether a kernel may insert into a container.
enum class Inserts { refused, accepted };

/// A copy of all lists, contiguous and in order.
struct PackedLists {
    std::shared_ptr<const Memory> offsets;  ///< cells + 1
    std::shared_ptr<const Memory> records;
    /// Of the lengths, after the wait for `reading`. Only slots need more than the sum: the others
    /// are 0 for a copy of contiguous lists.
    CellScan::Totals totals;
    ReadbackFence reading;
};

/// What a build keeps.
struct Kept {
    std::uint64_t records = 0;        ///< of the lists
    const Memory* offsets = nullptr;  ///< of their copy; null if the lists stay where they are
};

/// How a container keeps its nodes: a pool, and the passes of a build. One class a storage.
///
/// CONTRIBUTING.md says which places a new storage changes.
class ListStorage {
public:
    virtual ~ListStorage() = default;
    ListStorage(const ListStorage&) = delete;
    ListStorage& operator=(const ListStorage&) = delete;

    /// Empties the lists. Does not block.
    virtual void clear() = 0;

    /// A build is start(), then passes until review() says that the lists are complete; see
    /// build.cpp. More passes may follow, where another container needs them: they fill the lists
    /// anew. If the build keeps records, each pass inserts their copy again, unless mark() follows.
    virtual void start(const Kept& kept);
    /// Whether mark() works.
    [[nodiscard]] virtual bool can_mark() { return false; }
    /// From now on, passes keep the lists as they are now, and insert further records.
    virtual void mark() {}
    /// Takes away what was inserted since mark(), and ends it.
    virtual void return_to_mark() {}
    /// Enqueues what the next run of the kernels needs. Does not block.
    virtual void begin_pass() { clear(); }
    /// Enqueues the insert of all records of a copy, at the begin of a pass. Does not block.
    virtual void insert(const PackedLists& copy);
    /// Memory of at least this size that an append does not use; null if there is none.
    [[nodiscard]] virtual std::shared_ptr<const Memory> spare_memory(std::uint64_t) const {
        return {};
    }
    /// Enqueues what follows a run of the kernels, the reading of its counters above all. True if
    /// another pass must follow that needs no review of this one. Does not block.
    virtual bool end_pass() = 0;
    /// Takes the counters of the last pass into the report, and grows, stops or drops by the
    /// options. True if the lists are complete. Throws OverflowError; the caller empties the lists
    /// then. Blocks.
    virtual bool review(BuildReport& report) = 0;
    /// The event of the last command of end_pass(), if that is a read; null otherwise.
    [[nodiscard]] cl::Event last_read() const {
        return kept_.records == 0 ? reading_.event() : cl::Event();
    }
    /// Records that found no node in the last pass. Blocks.
    [[nodiscard]] std::uint64_t dropped() { return wait_for_counters().dropped; }
    [[nodiscard]] const Kept& kept() const { return kept_; }
    /// The copy of the kept records is there now; see Kept.
    void set_kept_offsets(const Memory& offsets) { kept_.offsets = &offsets; }
    /// Whether a review can change the lists.
    [[nodiscard]] bool may_grow() const { return options_.overflow != Overflow::drop; }

    /// Blocks until no read writes to this object's memory. Call it before the destructor.
    void wait_quietly() noexcept { reading_.wait_quietly(); }
    /// Gives the nodes' memory back, before another storage takes this one's place. What is left
    /// can only be destroyed, or be recovered. Blocks as wait_quietly() does.
    virtual void release_pool() noexcept;
    /// Empties the lists after a failed build and resets the passes. If the pool grows, it starts
    /// at 0 nodes when it has none or when `without_pool` is true.
    void recover(bool without_pool);

    /// Replaces all lists by those of a copy, in their order. `offsets` says where they go if they
    /// are contiguous; with the offsets of the copy, all of its records. `totals` are those of the
    /// new lengths. Throws OverflowError.
    virtual void load(const PackedLists& copy, const Memory& offsets,
                      const CellScan::Totals& totals);

    /// Enqueues a check for links, offsets and counts that are inconsistent, or differ from those
    /// of the last build. Does not block. Call the result once, when that build is finished; that
    /// call blocks.
    [[nodiscard]] virtual std::function<Validation()> validate() = 0;

    /// From now on, these cells alone have lists. The lists must be empty.
    virtual void set_slice(const Slice& slice) { slice_ = slice; }
    /// Nodes that lists need in so many cells, the longest of them as long, `total` together.
    [[nodiscard]] virtual std::uint64_t nodes_for(std::uint64_t total,
                                                  [[maybe_unused]] std::uint64_t longest,
                                                  [[maybe_unused]] std::uint64_t cells) const {
        return total;
    }
    /// The most nodes that the policy lets the pool have.
    [[nodiscard]] std::uint64_t most_nodes() const { return pool_.most_nodes(); }
    /// Makes room for such lists in the slice, if the policy is to grow. Throws OverflowError.
    virtual void reserve(std::uint64_t total, std::uint64_t longest);

    /// Enqueues the reading of the number of late inserts since the last clear(): low and high
    /// word.
    [[nodiscard]] PendingRead read_late_inserts(std::array<cl_uint, 2>& words) const {
        return pool_.read_late_inserts(words);
    }

    /// Adds what CELLIST_LISTS declares.
    virtual void add_to(Arguments& arguments, Inserts inserts = Inserts::refused) const;
    /// The same for a copy of the lists whose mode is CELLIST_CONTIGUOUS.
    void add_contiguous_to(Arguments& arguments, const Memory& records,
                           const Memory& offsets) const;

    /// Enqueues a copy of lists whose mode is CELLIST_CONTIGUOUS.
    void copy_contiguous(const PackedLists& to) const {
        copy(pool_.heads(), *to.offsets, to.offsets->size_bytes());
        copy(pool_.nodes(), *to.records, stored() * pool_.node_bytes());
    }

    [[nodiscard]] const NodePool& pool() const { return pool_; }
    [[nodiscard]] NodePool& pool() { return pool_; }
    /// How many records surely fit.
    [[nodiscard]] std::uint64_t capacity_nodes() const { return pool_.capacity_nodes(); }
    /// Device memory of all buffers that the storage keeps.
    [[nodiscard]] std::uint64_t bytes() const { return pool_.bytes(); }
    [[nodiscard]] std::uint64_t cells() const { return shape_.cells(); }
    [[nodiscard]] Storage kind() const { return options_.storage; }
    [[nodiscard]] const ListsOptions& options() const { return options_; }
    /// The mode in which the lists are read.
    [[nodiscard]] cl_uint mode() const { return view_.mode; }
    /// Records in the lists.
    [[nodiscard]] std::uint64_t stored() const { return expected_->stored; }

protected:
    ListStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options,
                cl_uint mode, const NodePool::Layout& layout);

    /// Makes the next pass the first of a build, after recover() has made a pool again.
    virtual void reset_passes() {}

    /// What kernels see of the container.
    [[nodiscard]] cellist_view view(Inserts inserts) const;
    void add_to(Arguments& arguments, const Memory& nodes, const Memory& heads,
                const cellist_view& view) const;
    [[nodiscard]] const RecordType& record() const { return kernels_.record(); }
    /// Throws Error if the policy needs a size that the options do not give.
    void require_given(bool given, const char* size) const;
    /// Makes a pool of this capacity. Throws MemoryError if a limit forbids it.
    void allocate_first(std::uint64_t capacity_nodes);
    /// Waits for the counters of the last pass.
    [[nodiscard]] Counters::Sum wait_for_counters();
    /// Sets words of the heads, and clears all counters. Does not block.
    void clear_words(cl_uint head, std::uint64_t first_word, std::uint64_t words) {
        pool_.clear(pool_.heads(), head, first_word, words);
    }
    /// Reports that `stored` of `demand` records for cells of the slice are in the lists.
    void update(BuildReport& report, std::uint64_t demand, std::uint64_t stored,
                std::uint64_t rejected);
    /// The same for a demand of the stored records and those that the counters say were dropped.
    void update(BuildReport& report, const Counters::Sum& counters, std::uint64_t stored) {
        update(report, stored + counters.dropped, stored, counters.rejected);
    }

    /// The state after a build, for a validation to compare with.
    struct Expected {
        std::uint64_t stored = 0;
        std::uint64_t counts_hash = 0;
    };
    /// Whether `saved_` is as large as this memory, or there is room for it.
    [[nodiscard]] bool can_save(const Memory& memory) const;
    /// Makes `saved_` as large as this memory.
    void allocate_saved(const Memory& memory);
    /// Enqueues a copy of the first bytes.
    void copy(const Memory& from, const Memory& to, std::uint64_t bytes) const;
    /// Nothing is in the lists any more, and a build may follow.
    void expect_nothing() { expected_ = std::make_shared<Expected>(); }

    /// What a validating kernel finds, on its way to the host.
    struct Findings {
        Memory memory;
        cellist_findings found{};
    };
    [[nodiscard]] Memory memory_for_findings() const {
        return {pool_.owner().state(), 1, sizeof(cellist_findings), "findings"};
    }
    /// Enqueues a validating kernel over all cells: (container, arguments..., findings). What it
    /// found is there when the reading has arrived.
    [[nodiscard]] PendingRead find(Findings& findings, Kernel& kernel,
                                   const Arguments& arguments) const;

    RecordKernels& kernels_;
    Shape shape_;
    ListsOptions options_;
    NodePool pool_;
    /// The mode, and what a storage knows of its slots and keys. view() adds the rest.
    cellist_view view_;
    Slice slice_;
    Kept kept_;                     ///< by this build
    std::optional<Expected> mark_;  ///< what mark() found; none without a mark
    Memory saved_;                  ///< what changes after mark(); stays for the next one
    std::shared_ptr<Expected> expected_ = std::make_shared<Expected>();  ///< of the last build
    Counters counters_;                                                  ///< of the last pass
    ReadbackFence reading_;  ///< what a review waits for: the last reading of the pass
};

/// The lowest bad cell, if there is one.
[[nodiscard]] inline std::optional<std::uint64_t> bad_cell(const cellist_findings& findings) {
    if (findings.bad_cell_from_end == 0) return {};
    return CELLIST_NONE - findings.bad_cell_from_end;
}

// make_<name>() of each storage, in storage_<name>.cpp: may throw as make_storage() does.
#define CELLIST_DECLARE_STORAGE(name, modes, unused, unused_too)                                   \
    std::unique_ptr<ListStorage> make_##name(RecordKernels& kernels, const Shape& shape,           \
                                             const ListsOptions& options);
CELLIST_STORAGES(CELLIST_DECLARE_STORAGE, , )
#undef CELLIST_DECLARE_STORAGE

/// The storage that the options name, with empty lists. Throws Error if a size exceeds a limit.
[[nodiscard]] std::unique_ptr<ListStorage> make_storage(RecordKernels& kernels, const Shape& shape,
                                                        const ListsOptions& options);

}  // namespace cellist::detail
