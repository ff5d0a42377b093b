// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <cellist/detail/lists_core.hpp>

#include "mpi/exchange.hpp"
#include "mpi/partition_plan.hpp"
#include "storage/container_storage.hpp"
#include "storage/node_pool.hpp"

namespace cellist::detail {

/// The kernels of exchange.cl for a record type. Compiles a kernel when it is first needed.
class ExchangeKernels {
public:
    /// The last of the definitions is the record.
    ExchangeKernels(MemoryOwner device, Definitions definitions)
        : device_(std::move(device)), definitions_(std::move(definitions)) {}

    /// `modes` are those of the containers that the kernel is first compiled for.
    [[nodiscard]] Kernel& get(const std::string& name, unsigned modes);
    [[nodiscard]] const RecordType& record() const { return definitions_.records.back(); }
    /// The last definition is a struct of a record and its cell, in the layout of cellist_node_T.
    [[nodiscard]] Definitions sent_definitions() const;

private:
    MemoryOwner device_;
    Definitions definitions_;
    std::map<std::string, Kernel> kernels_;
};

/// The foreign records of this rank, and the records that other ranks have sent to it.
class Outbox {
public:
    Outbox(const MemoryOwner& device, ExchangeKernels& kernels, const PartitionPlan& plan);

    /// Adds the outbox and the distribution, which CELLIST_LISTS declares after a container.
    void add_to(Arguments& arguments, cl_uint inserts) const;

    /// Fills the outbox: `run` runs kernels that insert what its argument says, CELLIST_INSERT_...
    /// It runs again for foreign records alone while the outbox is too small. Then puts the records
    /// in the order of the ranks, if there are any. Blocks.
    void fill(const std::function<void(cl_uint)>& run, cl_uint inserts);
    /// Fills the send lists, which have one cell for each rank: `insert` inserts into them. It runs
    /// again while they are too small. Blocks.
    void fill_send_lists(const std::function<void(ListsCore&)>& insert);
    void clear_send_lists();
    /// Sends the send lists. Collective. Blocks.
    void send();
    /// Enqueues a kernel that inserts the records that have arrived into the container of the
    /// arguments. Their cells are cells of that container.
    void insert_received(Arguments arguments);
    /// The number of records that have arrived.
    [[nodiscard]] std::uint64_t received() const { return received_; }
    /// Forgets the records that have arrived.
    void clear_received() { received_ = 0; }

    void set_message_bytes(std::uint64_t bytes) { exchange_.set_message_bytes(bytes); }
    void set_shares_memory(bool shares) { exchange_.set_shares_memory(shares); }

private:
    [[nodiscard]] cellist_view view() const;
    void clear() { pool_.clear(pool_.heads(), CELLIST_NONE, 0, 1); }
    [[nodiscard]] NodePool& send_pool() const { return send_->storage().in_use().pool(); }
    void reserve_send_lists(std::uint64_t records);

    const Communicator& communicator_;
    ExchangeKernels& kernels_;
    NodePool pool_;
    cellist_distribution distribution_;
    std::shared_ptr<ListsCore> send_;
    std::vector<cl_uint> send_offsets_;  ///< one for each rank, and the end of the last list
    Memory cuts_;
    Exchange exchange_;
    std::uint64_t received_ = 0;
};

}  // namespace cellist::detail
