// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/detail/memory.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>
#include <cellist/value.hpp>

namespace cellist::detail {

class Build;
class CellScan;
class ContainerStorage;
class ListSorter;
class ListStorage;
struct PackedLists;
class RecordKernels;

/// What lists are sorted by.
struct SortKey {
    std::string expression;  ///< of `record`
    unsigned bits;           ///< 32 or 64: what its values need
    Order order;
    Values values = {};                    ///< that the expression uses
    const char* what = "sort expression";  ///< in messages
};

/// What a container is doing. Build moves its containers from ready to building, pending and back,
/// or to failed; ListsCore does the rest.
enum class Phase {
    ready,     ///< the lists are complete
    building,  ///< kernels insert, or the build reviews what they inserted
    pending,   ///< the kernels are enqueued, and Build::finish() reviews what they inserted
    slicing,   ///< the lists of a slice are complete, and the caller reads them
    failed,    ///< the lists are in no order; ListsCore::make_ready() empties or restores them
};

/// The phase of a container, and what the phase needs.
struct BuildState {
    Phase phase = Phase::ready;
    std::shared_ptr<Build> build = {};  ///< that is pending
    bool without_pool = false;          ///< the failed lists give the memory of their nodes back
};

/// Lists without the record's C++ type: a storage, and the kernels that read and sort any storage.
/// The kernels see the record by its name in OpenCL C. Does not move in memory: a pending build
/// refers to it.
class CELLIST_API ListsCore : public std::enable_shared_from_this<ListsCore> {
public:
    ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions, const Shape& shape,
              const ListsOptions& options);
    ListsCore(const ListsCore&) = delete;
    ListsCore& operator=(const ListsCore&) = delete;
    ~ListsCore();

    /// A build of this container alone, from which Storage::automatic learns. Blocks.
    BuildReport build(const std::function<void()>& insert);

    /// Builds a range of cells at a time, and calls `read` for each.
    BuildReport build_slices(const std::function<void()>& insert,
                             const std::function<void(const Slice&)>& read);

    /// A build that keeps the records. Blocks.
    BuildReport append(const std::function<void()>& insert);
    /// Appends the records of other lists. Blocks.
    BuildReport merge(const ListsCore& other);
    /// A container with the same options and the same lists.
    [[nodiscard]] std::shared_ptr<ListsCore> copy() const;
    /// Removes the records for which an OpenCL C expression of `record` is not 0. Returns their
    /// number. Blocks.
    std::uint64_t remove_if(const std::string& expression, const Values& values);
    /// Keeps the first records of each list, and returns the number of the others. The function
    /// takes a copy of all lists, in which it may change the order of a list, and writes how many
    /// of each list stay: one word a cell. Blocks.
    std::uint64_t shorten(
        const std::function<void(const PackedLists&, const cl::Buffer&)>& write_lengths);

    void clear();
    /// Sorts at least the first `top_k` nodes of each list.
    cl::Event sort(const SortKey& key, std::uint32_t top_k);
    cl::Event sort_async(const SortKey& key);
    [[nodiscard]] std::function<Validation()> validate() const;

    /// Enqueues the reading of every list's length; `lengths` has them when it has arrived.
    [[nodiscard]] PendingRead read_lengths(std::vector<cl_uint>& lengths) const;
    /// Enqueues the writing of every list's length: one word a cell.
    void write_lengths(const cl::Buffer& lengths) const;
    /// Enqueues the writing of where each list begins if all lists are contiguous: cells + 1 words.
    void write_offsets(const cl::Buffer& offsets) const;
    /// Enqueues the counting of the cells by the length of their list; the last bin also has all
    /// longer ones. The bins are 0 before.
    void write_histogram(const cl::Buffer& histogram, cl_uint bins) const;

    /// Enqueues the reading of all lists: cells + 1 offsets, and the records. `allocate` takes the
    /// most records that there can be, and returns where they go. Blocks where there are too many
    /// records to copy at once, and for a pending build that may still change the lists.
    void download(ReadbackFence& done, std::vector<cl_uint>& offsets,
                  const std::function<void*(std::uint64_t)>& allocate) const;

    /// Enqueues the writing of cells + 1 offsets, calls `allocate` with the most records there can
    /// be, and enqueues the copy of a value of each record to the buffer that it returns, one list
    /// after the other. `declaration` declares a variable for a value in OpenCL C. `member`,
    /// appended to a record, selects the value, e.g. ".depth"; it is empty for the whole record.
    /// Blocks for a pending build that may still change the lists.
    void pack(const cl::Buffer& offsets,
              const std::function<const cl::Buffer&(std::uint64_t)>& allocate,
              const std::string& declaration, const std::string& member) const;

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] std::uint64_t capacity_nodes() const;
    [[nodiscard]] std::uint64_t pool_bytes() const;
    [[nodiscard]] const std::shared_ptr<DeviceState>& device() const { return device_.state(); }
    /// The storage in use, never Storage::automatic.
    [[nodiscard]] Storage storage_in_use() const;
    [[nodiscard]] std::string storage_reason() const;
    /// The mode in which the lists are read, as in view.h.
    [[nodiscard]] unsigned mode() const;

    /// Adds what CELLIST_LISTS declares. Blocks for a pending build that may still change the
    /// lists.
    void add_to(Arguments& arguments) const;

    /// Completes when all that was enqueued has.
    [[nodiscard]] cl::Event enqueue_marker() const;
    /// Ends a pending build, and empties failed lists. Throws what the build throws, or what still
    /// fails.
    void make_ready() const;
    /// The same, unless commands that are enqueued next find complete lists anyway.
    void make_ready_for_commands() const;
    /// Gives back what sorts and downloads keep for the next time, if a budget bounds the
    /// container: the pool of a build may need the room.
    void release_kept_buffers();
    /// Throws Error if the function that inserts uses the container that it fills.
    void require_not_building() const;
    /// The same, and throws Error if the caller is reading a slice of the container.
    void require_buildable() const;

    /// Whether kernels may insert.
    [[nodiscard]] bool is_building() const { return state_.phase == Phase::building; }
    /// Enqueues the reading of the number of late inserts: low and high word.
    [[nodiscard]] PendingRead read_late_inserts(std::array<cl_uint, 2>& words) const;
    /// E.g. "lists of Hit of shape 17 x 3".
    [[nodiscard]] std::string description() const;

    [[nodiscard]] ContainerStorage& storage() const { return *storage_; }
    [[nodiscard]] ListSorter& sorter();

    // For Build.
    void enter(BuildState state);
    /// The next start_build() keeps the records. Nothing has changed if the build fails before.
    void keep_records();
    void start_build();
    void begin_pass();
    [[nodiscard]] bool review(BuildReport& report);
    /// The lists are failed. If the device still works, they get the records back that an append
    /// keeps, or are empty. `without_pool` gives the memory of the nodes back; the next build grows
    /// anew.
    void fail(bool without_pool) noexcept;

private:
    struct Append;

    /// Throws Error if no Lists object refers to the built container any more, because the function
    /// that inserts has replaced it.
    static void require_owner(const std::shared_ptr<ListsCore>& self);
    [[nodiscard]] Range cell_range() const;
    [[nodiscard]] std::uint64_t most_records() const;
    [[nodiscard]] CellScan& scan(std::unique_ptr<CellScan>& once) const;
    void enqueue_lengths(const cl::Buffer& lengths) const;
    void enqueue_offsets(CellScan& scan, const cl::Buffer& offsets) const;
    [[nodiscard]] std::unique_ptr<PackedLists> packed() const;
    void count_lengths(PackedLists& copy) const;
    void restore(bool without_pool) const;
    void gather(std::uint64_t begin, std::uint64_t end, const cl::Buffer& offsets,
                const cl::Buffer& values, const std::string& declaration,
                const std::string& member) const;
    [[nodiscard]] std::vector<cl_uint> count(const std::function<void()>& insert,
                                             BuildReport& report);
    struct PlannedSlice {
        Slice range;
        std::uint64_t total;    ///< records of all cells
        std::uint64_t longest;  ///< records of one cell
    };
    [[nodiscard]] PlannedSlice plan_slice(std::uint64_t first,
                                          const std::vector<cl_uint>& counts) const;

    MemoryOwner device_;
    Shape shape_;
    ListsOptions options_;
    mutable BuildState state_;
    std::unique_ptr<RecordKernels> kernels_;
    std::unique_ptr<ContainerStorage> storage_;
    mutable std::unique_ptr<CellScan> scan_;
    mutable std::shared_ptr<const Memory> copied_offsets_;  ///< of packed(), for the next time
    std::unique_ptr<ListSorter> sorter_;
    mutable std::unique_ptr<Append> append_;  ///< that a build or a failure has not ended
};

}  // namespace cellist::detail
