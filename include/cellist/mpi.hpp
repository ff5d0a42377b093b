// SPDX-License-Identifier: MIT
#pragma once
// cellist::mpi: lists whose cells are distributed over the ranks of an MPI program.
//
// Link with cellist::mpi. The program initialises MPI itself, with MPI_Init_thread and at least
// MPI_THREAD_FUNNELED: drivers of processors use threads. docs/mpi.md is the guide.

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

/// Returns a device for this rank. The ranks of a host take its GPUs in turn, so more ranks than
/// GPUs share them. Without a GPU, or if the environment variable CELLIST_DEVICE is set, returns
/// Device::choose(). Collective. Throws what Device::choose() throws, on all ranks.
[[nodiscard]] CELLIST_API Device choose(MPI_Comm comm);

/// How cells are divided.
struct PartitionOptions {
    /// Layers of ghost cells around a block, along each axis that is divided. They hold copies of
    /// the records of other ranks after Lists::exchange_ghosts().
    std::uint32_t ghosts = 0;
    /// The axes that wrap around, as in ListsOptions::periodic.
    std::array<bool, 4> periodic = {};
    /// The number of blocks along each axis; their product is the number of ranks. Rank 0 has the
    /// first block, and ranks count along x first. All 0: chosen for short borders.
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
/// some blocks are empty. Copies share their content. Every constructor is collective over the
/// communicator.
class CELLIST_API Partition {
public:
    /// Divides the cells into blocks of about equal size. Duplicates `comm`: no message of the
    /// library meets one of the program.
    ///
    /// Throws Error on all ranks if:
    /// - the ranks name different shapes or options; the message has both.
    /// - the product of `blocks` is not the number of ranks.
    /// - there are more layers of ghost cells than cells along an axis of a block.
    /// - ghost cells on both sides would meet: along an axis that is periodic and divided, the
    ///   shape needs more than twice as many cells as layers.
    /// Throws Error if MPI is not initialised, or has a lower thread level than
    /// MPI_THREAD_FUNNELED, or if another thread than the main thread calls under that level.
    Partition(MPI_Comm comm, const Shape& shape, const PartitionOptions& options = {});

    /// Divides the cells into blocks of about equal weight. `weights` has a number for each cell,
    /// e.g. the lengths of the lists of a former build. The weights of all ranks are added, so
    /// each rank can pass those of its own records. Cuts lie between layers of cells: one layer is
    /// never divided. Throws what the constructor throws, and Error if the number of weights is not
    /// the number of cells. Ignores PartitionOptions::blocks.
    [[nodiscard]] static Partition balanced(MPI_Comm comm, const Shape& shape,
                                            const std::vector<std::uint64_t>& weights,
                                            const PartitionOptions& options = {});

    [[nodiscard]] const Shape& shape() const;
    [[nodiscard]] const PartitionOptions& options() const;
    [[nodiscard]] int rank() const;
    [[nodiscard]] int ranks() const;
    /// Returns this rank's own cells, or those of another rank.
    [[nodiscard]] const Block& block() const { return block(rank()); }
    [[nodiscard]] const Block& block(int rank) const;
    /// Returns the rank that owns a cell, 0 ... cells() - 1. Throws Error for other cells.
    [[nodiscard]] int owner(std::uint64_t cell) const;

    /// Returns the layers of ghost cells along each axis: 0 along axes that are not divided.
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
/// Kernels are those for cellist::Lists, and all cells are those of the whole shape. An insert on
/// any rank adds a record to the list of any cell: the build sends it to the rank that owns the
/// cell. A kernel that reads finds the lists of its rank's block, and of the ghost cells after
/// exchange_ghosts(); all other lists are empty.
///
/// After a sort, the lists are the same to the bit for any number of ranks.
///
/// Calls that are collective run on all ranks of the communicator, in the same order and, but for
/// ranges, kernels and their arguments, with the same arguments. If one rank
/// fails, all ranks throw the same error, whose message names that rank. An OpenClError's call()
/// then names the rank, too. All functions throw what those of cellist::Lists throw.
///
/// Owned by value: movable, not copyable. Using moved-from Lists throws Error.
template <class T>
class Lists {
public:
    /// Makes empty lists on this rank's device. Collective. Throws Error on all ranks if the ranks
    /// name different records, storages or policies; the message has both. The capacity, slots and
    /// the budget of the options hold for the lists of each rank; the outbox and the messages take
    /// further memory. The periodic axes are those of the partition.
    Lists(const Device& device, const Partition& partition, const ListsOptions& options = {})
        : partition_(partition),
          local_(detail::on_all_ranks<cellist::Lists<T>>(
              *partition.plan(),
              [&] {
                  return cellist::Lists<T>(device, partition.local_shape(),
                                           detail::local_options(*partition.plan(), options));
              })),
          core_("a distributed Lists object",
                std::make_unique<detail::DistributedCore>(
                    device.state(), detail::definitions_of_record<T>(), partition.plan(), options,
                    local_.core())) {}

    /// Builds the lists: runs `kernel(lists, args...)` over `range` on each rank, with the range
    /// and the arguments of that rank. Sends the records for cells of other ranks to these ranks.
    /// Collective. Returns the sums of all ranks' reports: `attempted == stored + dropped +
    /// rejected` holds exactly, and `passes` is the greatest number of any rank.
    ///
    /// The overflow policy works on each rank's pool. Under Overflow::stop, a demand that does not
    /// fit on one rank makes all ranks throw its OverflowError, and all lists are empty.
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
    /// Returns the sums of all ranks' reports of an append: `existing` are the records of the
    /// lists, and `attempted` the copies. Throws Error without ghost cells. After another
    /// exception, all lists are empty.
    ///
    /// The next build or exchange removes the copies. A sort before it does not order the ghost
    /// cells. The first exchange after a build takes the time of an append: see
    /// cellist::Lists::append(). Later ones also build the rank's own lists anew.
    BuildReport exchange_ghosts() { return core_->exchange_ghosts(); }

    /// Empties the lists. Collective.
    void clear() { core_->clear(); }

    /// Sorts every list, as cellist::Lists does. Collective, but sends no record.
    template <class M, std::same_as<T> R>
    void sort(M R::*member, Order order = Order::ascending) {
        on_all_ranks([&] { local_.sort(member, order); });
    }
    void sort(Order order = Order::ascending) requires detail::Scalar<T> {
        on_all_ranks([&] { local_.sort(order); });
    }
    void sort_by(const std::string& expression, Order order = Order::ascending) {
        on_all_ranks([&] { local_.sort_by(expression, order); });
    }
    void sort_by(const std::string& expression, const Values& values,
                 Order order = Order::ascending) {
        on_all_ranks([&] { local_.sort_by(expression, values, order); });
    }
    template <class M, std::same_as<T> R>
    void partial_sort(M R::*member, std::uint32_t count, Order order = Order::ascending) {
        on_all_ranks([&] { local_.partial_sort(member, count, order); });
    }

    /// Measures the lists of all ranks; ghost cells do not count. Collective. Blocks.
    [[nodiscard]] Lengths lengths() const { return core_->lengths(); }
    /// Checks the lists of all ranks, as cellist::Lists does. Collective. Blocks.
    [[nodiscard]] Validation validate() const { return core_->validate(); }

    /// Copies the lists of all ranks to the host memory of each rank. Collective. Blocks.
    [[nodiscard]] HostLists<T> download() const {
        std::vector<std::uint64_t> offsets;
        std::vector<T> records;
        core_->download(offsets, [&](std::uint64_t count) -> void* {
            records = detail::host_memory<T>(count);
            return records.data();
        });
        return HostLists<T>(shape(), std::move(offsets), std::move(records));
    }

    /// Returns this rank's lists, of partition().local_shape(): for neighbours(), nearest(), pack()
    /// and all other calls that read. Its cells are those of that shape. Partition::cell() and
    /// Partition::local_cell() convert them.
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
    void on_all_ranks(const std::function<void()>& call) const {
        detail::on_all_ranks(*partition_.plan(), call);
    }

    Partition partition_;
    cellist::Lists<T> local_;
    detail::Owned<std::unique_ptr<detail::DistributedCore>> core_;
};

}  // namespace cellist::mpi
