// SPDX-License-Identifier: MIT
#pragma once
// cellist::mpi: lists whose cells are distributed over the ranks of an MPI program.
//
// Link with cellist::mpi. The program initialises MPI itself, with MPI_Init_thread and at least
// MPI_THREAD_FUNNELED, because OpenCL drivers use threads. docs/mpi.md is the guide.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#ifndef OMPI_SKIP_MPICXX
#define OMPI_SKIP_MPICXX
#endif
#ifndef MPICH_SKIP_MPICXX
#define MPICH_SKIP_MPICXX
#endif
#include <mpi.h>

#include <cellist/detail/distributed_core.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/lists.hpp>

namespace cellist::mpi {

/// Returns a device for this rank. The ranks of a host take its GPUs in turn; if there are more
/// ranks than GPUs, ranks share GPUs. Without a GPU, returns Device::choose().
///
/// If the environment variable CELLIST_DEVICE is set, ranks take the devices that it names, as in
/// Device::choose(selector): an index names one device, and a name all devices that it matches. The
/// ranks of a host that have the same value take these devices in turn.
///
/// Collective. Blocks. Throws what Device::choose() throws, on all ranks. Throws Error if MPI is not
/// ready: see Partition.
[[nodiscard]] CELLIST_API Device choose(MPI_Comm comm);

/// How a Partition divides its cells.
struct PartitionOptions {
    /// The number of layers of ghost cells around a block, along each axis that is divided. After
    /// Lists::exchange_ghosts(), they hold copies of the records of other ranks.
    std::uint32_t ghosts = 0;
    /// The axes that wrap around, as in ListsOptions::periodic.
    std::array<bool, 4> periodic = {};
    /// The number of blocks along each axis; their product is the number of ranks. Rank 0 has the
    /// first block, and ranks count along x first. All 0: the library chooses blocks with short
    /// borders. If only some are 0, they count as 1.
    std::array<std::uint32_t, 4> blocks = {};
};

/// A box of cells.
struct Block {
    std::array<std::uint64_t, 4> origin = {};  ///< its first cell
    std::array<std::uint64_t, 4> extent = {};  ///< 1 in dimensions that the shape does not have

    [[nodiscard]] std::uint64_t cells() const {
        return extent[0] * extent[1] * extent[2] * extent[3];
    }
    friend bool operator==(const Block&, const Block&) = default;
};

/// The cells of a shape, divided into one block for each rank. If there are more ranks than cells,
/// some blocks are empty. Copies share their content.
///
/// Constructors and balanced() are collective and block. The destruction of the last copy is
/// collective, too: it frees the communicator. Lists keep a copy. All other functions are local.
class CELLIST_API Partition {
public:
    /// Divides the cells into blocks of about equal size. Duplicates `comm`, so that the messages
    /// of the library and of the program do not mix.
    ///
    /// Throws Error on all ranks if:
    /// - the ranks pass different shapes or options; the message has both.
    /// - the product of `blocks` is not the number of ranks.
    /// - a block has fewer cells along a divided axis than there are layers of ghost cells.
    /// - a divided axis is periodic and not longer than twice the layers of ghost cells.
    ///
    /// Throws Error if MPI is not ready: it is not initialised, is finalised, or has a lower thread
    /// level than MPI_THREAD_FUNNELED. Under that level only the main thread may call. Throws Error
    /// if `comm` is MPI_COMM_NULL or an intercommunicator.
    Partition(MPI_Comm comm, const Shape& shape, const PartitionOptions& options = {});

    /// Divides the cells into blocks of about equal weight. `weights` has a number for each cell of
    /// the whole shape, e.g. the lengths of the lists of an earlier build. The library adds the
    /// weights of all ranks, so each rank can pass those of its own records; the sums must fit into
    /// 64 bits. Each cut is a plane between two layers of a block, so a heavy layer limits the
    /// balance. Takes 8 bytes of host memory per cell. Throws what the constructor throws, and
    /// Error if the number of weights is not the number of cells. Ignores PartitionOptions::blocks.
    [[nodiscard]] static Partition balanced(MPI_Comm comm, const Shape& shape,
                                            const std::vector<std::uint64_t>& weights,
                                            const PartitionOptions& options = {});

    [[nodiscard]] const Shape& shape() const;
    [[nodiscard]] const PartitionOptions& options() const;
    [[nodiscard]] int rank() const;
    [[nodiscard]] int ranks() const;
    /// Returns this rank's own cells, or those of another rank. Throws Error if there is no such
    /// rank.
    [[nodiscard]] const Block& block() const { return block(rank()); }
    [[nodiscard]] const Block& block(int rank) const;
    /// Returns the rank that owns a cell of the shape. Throws Error for a cell outside the shape.
    [[nodiscard]] int owner(std::uint64_t cell) const;

    /// Returns the number of layers of ghost cells along each axis: 0 along axes that are not
    /// divided.
    [[nodiscard]] std::array<std::uint64_t, 4> ghosts() const;
    /// Returns the shape of Lists::local(): the block, and the layers of ghost cells on both sides.
    [[nodiscard]] Shape local_shape() const;
    /// Returns the index in local_shape() of a cell of this rank's block. Empty for other cells.
    [[nodiscard]] std::optional<std::uint64_t> local_cell(std::uint64_t cell) const;
    /// Returns the reverse: the cell of the whole shape. Empty if it is a ghost cell.
    [[nodiscard]] std::optional<std::uint64_t> cell(std::uint64_t local_cell) const;

    /// @private
    [[nodiscard]] const std::shared_ptr<const detail::PartitionPlan>& plan() const {
        return plan_.pointer();
    }

private:
    explicit Partition(std::shared_ptr<const detail::PartitionPlan> plan)
        : plan_("a Partition", std::move(plan)) {}
    detail::Owned<std::shared_ptr<const detail::PartitionPlan>> plan_;
};

/// A list of records T for each cell of a shape, in the device memory of all ranks.
///
/// Kernels are those for cellist::Lists, and name cells of the whole shape. An insert on any rank
/// adds a record to the list of any cell: the build sends it to the rank that owns the cell. A
/// kernel that reads finds the lists of its rank's block, and of the ghost cells after
/// exchange_ghosts(); all other lists are empty.
///
/// After sort() or sort_by(), the lists are the same to the bit for any number of ranks, unless
/// records were dropped.
///
/// Make collective calls on all ranks of the communicator, in the same order, with the same
/// arguments but for kernels, ranges and what kernels take. Each blocks until the other ranks have
/// made it, too. If a rank fails, all ranks throw the same error. They also throw Error if they
/// make different calls, or sort by different keys. With several ranks, its message (or call() of
/// an OpenClError) begins with the number of the failed rank, and an exception of a type that the
/// library does not have becomes Error. All functions throw what those of cellist::Lists throw.
///
/// Owned by value: movable, not copyable. Using moved-from Lists throws Error.
template <class T>
class Lists {
public:
    /// Makes empty lists on this rank's device. Collective. The capacity, slots and budget of the
    /// options apply to the lists of each rank. The outbox and the messages take further memory.
    ///
    /// Throws Error on all ranks if the ranks pass different records, storages or policies; the
    /// message has both. The partition says which axes are periodic: throws Error if the options
    /// name other axes.
    Lists(const Device& device, const Partition& partition, const ListsOptions& options = {})
        : partition_(partition),
          local_(detail::on_all_ranks<cellist::Lists<T>>(
              *partition.plan(), "Lists",
              [&] {
                  return cellist::Lists<T>(device, partition.local_shape(),
                                           detail::local_options(*partition.plan(), options));
              })),
          core_("a distributed Lists object",
                std::make_unique<detail::DistributedCore>(
                    device.state(), detail::definitions_of_record<T>(), partition.plan(), options,
                    local_.core())) {}

    /// Builds the lists: runs `kernel(lists, args...)` over `range` on each rank, with the range
    /// and the arguments of that rank. Sends records for cells of other ranks to those ranks.
    /// Collective. Blocks. Returns the sums of all ranks' reports: `attempted == stored + dropped +
    /// rejected` holds exactly, and `passes` is the greatest number of any rank.
    ///
    /// The overflow policy applies to each rank's pool. If a rank throws OverflowError, all ranks
    /// do. Throws MemoryError if more records arrive at a rank than a pool can hold. After any
    /// exception, the lists of all ranks are empty.
    template <class... Args>
    BuildReport build(Kernel& kernel, const Range& range, const Args&... args) {
        return core_->build([&] {
            detail::Arguments arguments;
            arguments.add(*this);
            (arguments.add(args), ...);
            kernel.enqueue(range, arguments);
        });
    }
    /// Builds the lists with several kernels, as cellist::Lists::build does. A rank without records
    /// passes a function that enqueues nothing.
    BuildReport build(std::invocable auto&& insert) { return core_->build(std::ref(insert)); }

    /// Copies the records of the cells next to each rank's block into its ghost cells. Collective.
    /// Blocks. Returns the sums of all ranks' reports of an append: `existing` counts the records
    /// before it, and `attempted` the copies. Throws Error if PartitionOptions::ghosts is 0. After
    /// another exception, all lists are empty.
    ///
    /// The next build or exchange removes the copies. The order of the lists is undefined
    /// afterwards, so sort after the exchange. The first exchange after a build takes the time of
    /// an append: see cellist::Lists::append(). A later one first removes the ghost cells.
    BuildReport exchange_ghosts() { return core_->exchange_ghosts(); }

    /// Empties the lists. Collective.
    void clear() { core_->clear(); }

    /// Sorts every list of all ranks, ghost cells included, as cellist::Lists does. Collective, but
    /// sends no records. Blocks.
    template <class M, std::same_as<T> R>
    void sort(M R::*member, Order order = Order::ascending) {
        on_all_ranks(call("sort", detail::member_name(member), order),
                     [&] { local_.sort(member, order); });
    }
    void sort(Order order = Order::ascending) requires detail::Scalar<T> {
        on_all_ranks(call("sort", "", order), [&] { local_.sort(order); });
    }
    void sort_by(const std::string& expression, Order order = Order::ascending) {
        on_all_ranks(call("sort_by", expression, order),
                     [&] { local_.sort_by(expression, order); });
    }
    void sort_by(const std::string& expression, const Values& values,
                 Order order = Order::ascending) {
        on_all_ranks(call("sort_by", expression, order),
                     [&] { local_.sort_by(expression, values, order); });
    }
    template <class M, std::same_as<T> R>
    void partial_sort(M R::*member, std::uint32_t count, Order order = Order::ascending) {
        on_all_ranks(call("partial_sort of " + std::to_string(count) + " records",
                          detail::member_name(member), order),
                     [&] { local_.partial_sort(member, count, order); });
    }

    /// Measures the lists of all ranks; ghost cells do not count. Collective. Blocks.
    [[nodiscard]] Lengths lengths() const { return core_->lengths(); }
    /// Checks the lists of all ranks, as cellist::Lists does. Returns the sums of all ranks.
    /// Collective. Blocks.
    [[nodiscard]] Validation validate() const { return core_->validate(); }

    /// Copies the lists of all ranks, without ghost cells, to host memory of each rank, which must
    /// have room for all records. Collective. Blocks.
    [[nodiscard]] HostLists<T> download() const {
        std::vector<std::uint64_t> offsets;
        std::vector<T> records;
        core_->download(offsets, [&](std::uint64_t count) -> void* {
            records = detail::host_memory<T>(count);
            return records.data();
        });
        return HostLists<T>(shape(), std::move(offsets), std::move(records));
    }

    /// Returns this rank's lists, for neighbours(), nearest(), pack() and all other calls that
    /// read. They have the shape partition().local_shape(), with ghost cells. Partition::cell() and
    /// Partition::local_cell() convert between its cells and those of the whole shape.
    [[nodiscard]] const cellist::Lists<T>& local() const { return local_; }
    [[nodiscard]] const Partition& partition() const { return partition_; }
    [[nodiscard]] const Shape& shape() const { return partition_.shape(); }

    /// @private
    void add_to(detail::Arguments& arguments) const { core_->add_to(arguments); }
    /// @private
    [[nodiscard]] detail::Definitions definitions() const { return core_->definitions(); }
    /// @private
    [[nodiscard]] detail::DistributedCore& core() const { return *core_; }

private:
    /// A sort in words, which all ranks compare.
    static std::string call(const std::string& name, const std::string& key, Order order) {
        return name + (key.empty() ? "" : " by " + key) +
               (order == Order::ascending ? ", ascending" : ", descending");
    }
    void on_all_ranks(const std::string& name, const std::function<void()>& call) const {
        detail::on_all_ranks(*partition_.plan(), name, call);
    }

    Partition partition_;
    cellist::Lists<T> local_;
    detail::Owned<std::unique_ptr<detail::DistributedCore>> core_;
};

}  // namespace cellist::mpi
