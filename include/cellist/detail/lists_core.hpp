#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

namespace cellist::detail {

class Build;
class CellScan;
class StorageTuner;
class ListSorter;
class ListStorage;
struct Measurement;

/// What lists are sorted by.
struct SortKey {
    std::string expression;  ///< of `record`
    unsigned bits;           ///< 32 or 64: what its values need
    Order order;

    friend auto operator<=>(const SortKey&, const SortKey&) = default;
};

/// Lists without the record's C++ type: a storage, and the kernels that read and sort any storage.
/// The kernels see the record by its name in OpenCL C. Stays where it is: a build that is pending
/// refers to it.
class ListsCore : public std::enable_shared_from_this<ListsCore> {
public:
    ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions, const Shape& shape,
              const ListsOptions& options);
    ListsCore(const ListsCore&) = delete;
    ListsCore& operator=(const ListsCore&) = delete;
    ~ListsCore();

    /// Enqueues a build of all containers at once: `insert` runs the kernels that fill them.
    static std::shared_ptr<Build> start_build(std::vector<ListsCore*> containers,
                                              std::function<void()> insert);
    /// Completes after the first passes. The build has failed where this throws.
    [[nodiscard]] static cl::Event marker(Build& build);
    /// Completes when all that was enqueued on the queues of the containers has.
    [[nodiscard]] static cl::Event marker_of(const std::vector<ListsCore*>& containers);
    /// The rest of a build: a report for each container. Blocks.
    static const std::vector<BuildReport>& finish(Build& build);

    /// A build of this container alone, from which Storage::automatic learns. Blocks.
    BuildReport build(const std::function<void()>& insert);
    /// The same, with the time that it takes and a read of every record after it. Blocks.
    BuildReport measure(const std::function<void()>& insert, Measurement& trial);

    /// Builds a range of cells at a time, and calls `read` for each.
    BuildReport build_slices(const std::function<void()>& insert,
                             const std::function<void(const Slice&)>& read);

    void clear();
    /// Sorts `front` nodes of each list at least.
    cl::Event sort(const SortKey& key, std::uint32_t front);
    cl::Event sort_async(const SortKey& key);
    /// Divides the work of sorts as on a device of this type; for tests.
    void sort_as_on(cl_device_type type);
    [[nodiscard]] std::function<Validation()> validate() const;

    /// Enqueues the reading of every list's length; `lengths` has them when it has arrived.
    [[nodiscard]] PendingRead read_lengths(std::vector<cl_uint>& lengths) const;

    /// Enqueues the reading of all lists: cells + 1 offsets, and the records. `allocate` takes the most
    /// records that there can be, and returns where they go. Blocks where there are too many records to
    /// copy at once, and for a pending build that may still change the lists.
    void download(ReadbackFence& done, std::vector<cl_uint>& offsets,
                  const std::function<void*(std::uint64_t)>& allocate) const;

    /// Enqueues the writing of cells + 1 offsets, calls `allocate` with the most records there can be,
    /// and enqueues the copy of a value of each record to the buffer that it returns, one list after the
    /// other. `declaration` declares a variable for a value in OpenCL C. `member`, appended to a record,
    /// selects the value, e.g. ".depth"; it is empty for the whole record. Blocks for a pending build
    /// that may still change the lists.
    void pack(const cl::Buffer& offsets,
              const std::function<const cl::Buffer&(std::uint64_t)>& allocate,
              const std::string& declaration, const std::string& member) const;

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] std::uint64_t capacity_nodes() const;
    [[nodiscard]] std::uint64_t pool_bytes() const;
    [[nodiscard]] const std::shared_ptr<DeviceState>& device() const { return device_.state(); }
    [[nodiscard]] const std::string& record() const { return definitions_.records.back().name; }
    /// What is in use, never Storage::automatic.
    [[nodiscard]] Storage storage_in_use() const { return in_use_; }
    [[nodiscard]] std::string storage_reason() const;
    /// Of Storage::automatic; null otherwise. For tests, which tell it of times of their own.
    [[nodiscard]] StorageTuner* tuner() const { return tuner_.get(); }
    /// The mode in which the lists are read, as in view.h.
    [[nodiscard]] unsigned mode() const;

    /// Adds what CELLIST_LISTS declares. Blocks for a pending build that may still change the lists.
    void add_to(Arguments& arguments) const;

    /// Completes when all that was enqueued has.
    [[nodiscard]] cl::Event marker() const;
    /// Ends a pending build, and empties lists that a failure has left in no order. Throws what the
    /// build throws, or what fails still.
    void settle() const;
    /// The same where what is enqueued next would otherwise find incomplete lists.
    void settle_for_commands() const;
    /// Throws Error where the function that inserts uses the container that it fills.
    void refuse_while_open() const;
    /// The same, and throws Error where the caller is reading a slice of the container.
    void refuse_build() const;

    /// Whether kernels may insert now.
    [[nodiscard]] bool is_open() const;
    /// Enqueues the reading of the number of inserts that were refused outside a build: low and high word.
    [[nodiscard]] PendingRead read_late(std::array<cl_uint, 2>& words) const;
    /// E.g. "lists of Hit of shape 17 x 3".
    [[nodiscard]] std::string description() const;

    // For Build.
    [[nodiscard]] ListStorage& storage() const { return *storage_; }
    /// Puts the chosen storage in place, and starts a build in it.
    void start();
    /// What the storage's review() says. Where an automatic storage fails and another may not, that
    /// takes its place, and the lists are not complete.
    bool review(BuildReport& report);
    /// Whether review() can change the lists.
    [[nodiscard]] bool review_may_change() const;
    void set_pending(std::shared_ptr<Build> build) { pending_ = std::move(build); }
    void empty_after_failure(bool without_pool) noexcept;

private:
    [[nodiscard]] ListSorter& sorter();
    /// Throws Error where no Lists object refers to the built container any more, because the function
    /// that inserts has replaced it.
    static void refuse_orphan(const std::shared_ptr<ListsCore>& self);
    BuildReport build_once(const std::function<void()>& insert);
    void measure_walk(Measurement& trial) const;
    void use(Storage storage);
    bool replace(const BuildReport& report, const char* why, bool for_ever);
    Kernel& kernel(const std::string& name, std::string_view source,
                   const std::string& definitions = {}) const;
    [[nodiscard]] Range cell_range() const;
    [[nodiscard]] Memory device_lengths(std::uint64_t words) const;
    [[nodiscard]] std::uint64_t most_records() const;
    [[nodiscard]] Memory device_offsets() const;
    void gather(std::uint64_t begin, std::uint64_t end, const Memory& offsets,
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
    Definitions definitions_;
    Shape shape_;
    ListsOptions options_;
    std::unique_ptr<StorageTuner> tuner_;  ///< of Storage::automatic
    Storage in_use_;
    bool has_chosen_ = false;  ///< storage_ is what use() made, with its pool
    std::unique_ptr<ListStorage> storage_;
    std::shared_ptr<Build> pending_;  ///< a build that is not finished yet
    bool in_slices_ = false;          ///< a build in slices is under way: the storage stays
    bool reading_slice_ = false;
    mutable bool broken_ = false;  ///< lists in no order: a failed build or clear() left them so
    bool without_pool_ = false;    ///< the memory of the nodes is to be given back then
    mutable std::map<std::string, Kernel> kernels_;  ///< the library's, by name and definitions
    mutable std::unique_ptr<CellScan> scan_;
    std::unique_ptr<ListSorter> sorter_;
};

}  // namespace cellist::detail
