// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <utility>

#include <cellist/detail/distributed_core.hpp>

#include "mpi/outbox.hpp"
#include "mpi/partition_plan.hpp"

namespace cellist::detail {

namespace {

std::string lists_text(const RecordType& record, const ListsOptions& options) {
    std::string text = "lists of " + record.type();
    if (record.is_struct) {
        text += " {";
        for (const RecordMember& member : record.members)
            text += " " + member.type + " " + member.name + member.extents + ";";
        text += " }";
    }
    text += " of " + std::to_string(record.size) + " bytes in ";
    if (const NearestKey* key = options.storage.nearest_key())
        text += "the storage of nearest(" + std::string(key->member) + ", " +
                std::to_string(key->slots) + ")";
    else
        text += std::string("Storage::") + name_of(options.storage);
    constexpr std::array policies{"grow", "stop", "drop"};
    return text + " with Overflow::" + policies[static_cast<std::size_t>(options.overflow)];
}

cl_uint4 vector_of(const Position& position) {
    cl_uint4 vector{};
    for (std::size_t axis = 0; axis < 4; ++axis)
        vector.s[axis] = static_cast<cl_uint>(position[axis]);
    return vector;
}

std::uint64_t cells_of(const Position& extent) {
    return extent[0] * extent[1] * extent[2] * extent[3];
}

}  // namespace

void on_all_ranks(const PartitionPlan& plan, const std::string& name,
                  const std::function<void()>& call) {
    plan.communicator().begin(name);
    plan.communicator().together(call);
}

ListsOptions local_options(const PartitionPlan& plan, const ListsOptions& options) {
    if (options.periodic != ListsOptions{}.periodic && options.periodic != plan.options().periodic)
        throw Error(
            "the partition says which axes of distributed lists are periodic: name them in "
            "PartitionOptions::periodic");
    ListsOptions local = options;
    // Along divided axes, ghost cells take the place of wrapping around.
    for (std::size_t axis = 0; axis < 4; ++axis)
        local.periodic[axis] =
            plan.options().periodic[axis] && plan.own().extent[axis] == plan.shape().extent(axis);
    return local;
}

struct DistributedCore::Impl {
    Impl(std::shared_ptr<DeviceState> state, Definitions its_definitions,
         std::shared_ptr<const PartitionPlan> its_plan, const ListsOptions& options,
         ListsCore& its_lists)
        : plan(std::move(its_plan)),
          communicator(plan->communicator()),
          lists(its_lists),
          device(std::move(state)),
          definitions(std::move(its_definitions)),
          is_automatic(Storage(options.storage) == Storage::automatic),
          kernels(device, definitions),
          outbox(device, kernels, *plan) {}

    /// Whether there are several ranks: kernels then need the distribution.
    [[nodiscard]] bool is_divided() const { return communicator.size() > 1; }

    void add_to(Arguments& arguments) const {
        arguments.add_lists(lists);
        if (is_divided()) outbox.add_to(arguments, inserts);
    }

    /// Runs the user's kernels, which may insert what `mode` says: CELLIST_INSERT_...
    void run(const std::function<void()>& insert, cl_uint mode) {
        inserts = mode;
        insert();
        inserts = 0;
    }

    /// Collects the foreign records and sends them, on all ranks.
    void exchange(const std::function<void()>& insert, cl_uint mode) {
        agree([&] { outbox.fill([&](cl_uint now) { run(insert, now); }, mode); });
        send();
    }

    /// Sends the send lists, on all ranks.
    void send() {
        remember([&] { outbox.send(); });
    }

    /// Calls a function on all ranks within a build, and remembers that all know of its failure.
    void agree(const std::function<void()>& call) {
        remember([&] { communicator.together(call); });
    }

    /// Calls a function that throws the same on all ranks, and keeps what it throws.
    void remember(const std::function<void()>& call) {
        try {
            call();
        } catch (...) {
            agreed = std::current_exception();
            throw;
        }
    }

    /// Calls a function that changes the lists of this rank, and may call agree(). After a failure
    /// on any rank, all lists are empty.
    void change(const std::function<void()>& call) {
        agreed = nullptr;
        std::exception_ptr error;
        try {
            call();
        } catch (...) {
            error = std::current_exception();
        }
        try {
            // All ranks have thrown an agreed failure. Any other is new to the other ranks, whose
            // next collective call is an agree(), here or earlier.
            if (agreed) std::rethrow_exception(std::exchange(agreed, nullptr));
            communicator.agree(error);
        } catch (...) {
            inserts = 0;
            has_ghosts = false;
            try {
                lists.clear();
            } catch (...) {
                // The first error is rethrown below.
            }
            throw;
        }
    }

    [[nodiscard]] Range box_range(const Position& extent) const {
        return Range::padded(cells_of(extent));
    }

    void copy_ghosts() {
        if (plan->ghost_copies().empty()) return outbox.clear_send_lists();
        outbox.fill_send_lists([&](ListsCore& send) {
            for (const GhostCopy& copy : plan->ghost_copies()) {
                Arguments arguments;
                send.add_to(arguments);
                lists.add_to(arguments);
                arguments.add(vector_of(copy.first));
                arguments.add(vector_of(copy.extent));
                arguments.add(vector_of(copy.target));
                arguments.add(vector_of(plan->held(copy.rank)));
                arguments.add(static_cast<cl_uint>(copy.rank));
                kernels.get("cellist_copy_box", arguments.modes())
                    .enqueue(box_range(copy.extent), arguments);
            }
        });
    }

    void remove_ghosts() {
        lists.shorten([&](const PackedLists&, const cl::Buffer& lengths) {
            Arguments arguments;
            lists.add_to(arguments);
            arguments.add(lengths);
            arguments.add(vector_of(plan->ghosts()));
            arguments.add(vector_of(plan->own().extent));
            kernels.get("cellist_own_lengths", arguments.modes())
                .enqueue(Range::padded(lists.shape().cells()), arguments);
        });
        has_ghosts = false;
    }

    /// The sum of all ranks' reports. Collective.
    [[nodiscard]] BuildReport sum(const BuildReport& report) const {
        std::array<std::uint64_t, 6> sums{report.attempted, report.stored,         report.dropped,
                                          report.rejected,  report.capacity_nodes, report.existing};
        communicator.reduce(sums.data(), sums.size(), MPI_SUM);
        std::uint64_t passes = report.passes;
        communicator.reduce(&passes, 1, MPI_MAX);
        return {.attempted = sums[0],
                .stored = sums[1],
                .dropped = sums[2],
                .rejected = sums[3],
                .capacity_nodes = sums[4],
                .passes = static_cast<std::uint32_t>(passes),
                .existing = sums[5]};
    }

    /// Calls a function for each cell of a rank's block: its index in the whole shape and in the
    /// rank's lists.
    void for_each_own_cell(int rank,
                           const std::function<void(std::uint64_t, std::uint64_t)>& call) const {
        const mpi::Block& block = plan->block(rank);
        const Position held = plan->held(rank), &ghosts = plan->ghosts();
        Position at{};
        for (at[3] = 0; at[3] < block.extent[3]; ++at[3])
            for (at[2] = 0; at[2] < block.extent[2]; ++at[2])
                for (at[1] = 0; at[1] < block.extent[1]; ++at[1])
                    for (at[0] = 0; at[0] < block.extent[0]; ++at[0]) {
                        std::uint64_t local = 0;
                        Position global{};
                        for (std::size_t axis = 4; axis-- > 0;) {
                            local = local * held[axis] + at[axis] + ghosts[axis];
                            global[axis] = block.origin[axis] + at[axis];
                        }
                        call(plan->cell(global), local);
                    }
    }

    std::shared_ptr<const PartitionPlan> plan;
    const Communicator& communicator;
    ListsCore& lists;
    MemoryOwner device;
    Definitions definitions;
    bool is_automatic;
    ExchangeKernels kernels;
    Outbox outbox;
    cl_uint inserts = 0;  ///< what kernels may insert now
    bool has_ghosts = false;
    std::exception_ptr agreed;  ///< a failure that all ranks have thrown
};

DistributedCore::DistributedCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                                 std::shared_ptr<const PartitionPlan> plan,
                                 const ListsOptions& options, ListsCore& local) {
    plan->communicator().require_same(lists_text(definitions.records.back(), options), "lists");
    on_all_ranks(*plan, "Lists", [&] {
        impl_ =
            std::make_unique<Impl>(std::move(device), std::move(definitions), plan, options, local);
    });
}

DistributedCore::~DistributedCore() = default;

BuildReport DistributedCore::build(const std::function<void()>& insert) {
    Impl& own = *impl_;
    BuildReport report;
    own.communicator.begin("build");
    own.change([&] {
        own.outbox.clear_received();
        own.has_ghosts = false;
        bool has_sent = !own.is_divided();
        // Storage::automatic measures builds: keep the exchange out of them.
        if (own.is_automatic && !has_sent) {
            own.exchange(insert, CELLIST_INSERT_FOREIGN);
            has_sent = true;
        }
        report = own.lists.build([&] {
            if (!has_sent)
                own.exchange(insert, CELLIST_INSERT_OWN | CELLIST_INSERT_FOREIGN);
            else
                own.run(insert, CELLIST_INSERT_OWN);
            has_sent = true;
            own.run(
                [&] {
                    Arguments arguments;
                    own.add_to(arguments);
                    own.outbox.insert_received(std::move(arguments));
                },
                CELLIST_INSERT_OWN);
        });
    });
    return own.sum(report);
}

BuildReport DistributedCore::exchange_ghosts() {
    Impl& own = *impl_;
    if (own.plan->options().ghosts == 0)
        throw Error(
            "a partition without ghost cells has none to exchange: set "
            "PartitionOptions::ghosts");
    BuildReport report;
    own.communicator.begin("exchange_ghosts");
    own.change([&] {
        own.agree([&] {
            if (own.has_ghosts) own.remove_ghosts();
            own.copy_ghosts();
        });
        own.send();
        own.has_ghosts = true;
        if (own.outbox.received() == 0) {
            const std::uint64_t stored = own.lists.storage().in_use().stored();
            report = {
                .stored = stored, .capacity_nodes = own.lists.capacity_nodes(), .existing = stored};
            return;
        }
        report = own.lists.append([&] {
            Arguments arguments;
            own.lists.add_to(arguments);
            own.outbox.insert_received(std::move(arguments));
        });
    });
    return own.sum(report);
}

void DistributedCore::clear() {
    impl_->has_ghosts = false;
    on_all_ranks(*impl_->plan, "clear", [&] { impl_->lists.clear(); });
}

void DistributedCore::add_to(Arguments& arguments) const { impl_->add_to(arguments); }

Definitions DistributedCore::definitions() const {
    Definitions all = impl_->definitions;
    all.modes = impl_->lists.mode() | (impl_->is_divided() ? CELLIST_DISTRIBUTED_MODE : 0);
    return all;
}

void DistributedCore::set_message_bytes(std::uint64_t bytes) {
    impl_->outbox.set_message_bytes(bytes);
}

void DistributedCore::set_shares_memory(bool shares) { impl_->outbox.set_shares_memory(shares); }

Lengths DistributedCore::lengths() const {
    const Impl& own = *impl_;
    std::vector<cl_uint> of_own;
    on_all_ranks(*own.plan, "lengths", [&] {
        std::vector<cl_uint> all;
        ReadbackFence fence;
        fence.add(own.lists.read_lengths(all));
        fence.wait();
        of_own.reserve(own.plan->own().cells());
        own.for_each_own_cell(own.communicator.rank(), [&](std::uint64_t, std::uint64_t local) {
            of_own.push_back(all[local]);
        });
    });
    const Lengths mine(of_own);
    Lengths sum;
    for (int rank = 0; rank < own.communicator.size(); ++rank) {
        std::uint64_t entries = mine.histogram.size();
        own.communicator.broadcast(&entries, sizeof entries, rank);
        std::vector<std::array<std::uint64_t, 2>> pairs;
        for (const auto& [length, cells] : mine.histogram) pairs.push_back({length, cells});
        pairs.resize(entries);
        own.communicator.broadcast(pairs.data(), entries * sizeof pairs[0], rank);
        for (const auto& [length, cells] : pairs) {
            sum.histogram[length] += cells;
            sum.longest = std::max(sum.longest, length);
            sum.nonempty_cells += length > 0 ? cells : 0;
            sum.total += length * cells;
        }
    }
    return sum;
}

Validation DistributedCore::validate() const {
    const Impl& own = *impl_;
    Validation found;
    on_all_ranks(*own.plan, "validate", [&] { found = own.lists.validate()(); });
    std::array<std::uint64_t, 4> sums{found.broken_links, found.repeated_nodes, found.lost_nodes,
                                      found.late_inserts};
    own.communicator.reduce(sums.data(), sums.size(), MPI_SUM);
    std::uint64_t lowest = CELLIST_NONE;
    if (found.first_bad_cell)
        own.for_each_own_cell(own.communicator.rank(),
                              [&](std::uint64_t cell, std::uint64_t local) {
                                  if (local == *found.first_bad_cell) lowest = cell;
                              });
    own.communicator.reduce(&lowest, 1, MPI_MIN);
    Validation all;
    all.broken_links = sums[0];
    all.repeated_nodes = sums[1];
    all.lost_nodes = sums[2];
    all.late_inserts = sums[3];
    if (lowest != CELLIST_NONE) all.first_bad_cell = lowest;
    return all;
}

void DistributedCore::download(std::vector<std::uint64_t>& offsets,
                               const std::function<void*(std::uint64_t)>& allocate) const {
    const Impl& own = *impl_;
    const std::size_t bytes = own.definitions.records.back().size;
    const std::uint64_t cells = own.plan->shape().cells();
    std::vector<std::byte> mine;
    std::byte* all = nullptr;
    std::vector<std::byte> of_rank;
    on_all_ranks(*own.plan, "download", [&] {
        std::vector<cl_uint> starts;
        std::vector<std::byte> records;
        {
            ReadbackFence fence;
            own.lists.download(fence, starts, [&](std::uint64_t count) -> void* {
                records = host_memory<std::byte>(count * bytes);
                return records.data();
            });
            fence.wait();
        }
        offsets = host_memory<std::uint64_t>(cells + 1);
        own.for_each_own_cell(own.communicator.rank(), [&](std::uint64_t cell,
                                                           std::uint64_t local) {
            offsets[cell + 1] = starts[local + 1] - starts[local];
            mine.insert(mine.end(),
                        records.begin() + static_cast<std::ptrdiff_t>(starts[local] * bytes),
                        records.begin() + static_cast<std::ptrdiff_t>(starts[local + 1] * bytes));
        });
    });
    own.communicator.reduce(offsets.data(), offsets.size(), MPI_SUM);
    for (std::uint64_t cell = 0; cell < cells; ++cell) offsets[cell + 1] += offsets[cell];
    std::vector<std::uint64_t> sizes(static_cast<std::size_t>(own.communicator.size()), 0);
    sizes[static_cast<std::size_t>(own.communicator.rank())] = mine.size();
    own.communicator.reduce(sizes.data(), sizes.size(), MPI_SUM);
    on_all_ranks(*own.plan, "download", [&] {
        all = static_cast<std::byte*>(allocate(offsets[cells]));
        of_rank = host_memory<std::byte>(*std::max_element(sizes.begin(), sizes.end()));
    });
    for (int rank = 0; rank < own.communicator.size(); ++rank) {
        if (rank == own.communicator.rank()) std::copy(mine.begin(), mine.end(), of_rank.begin());
        own.communicator.broadcast(of_rank.data(), sizes[static_cast<std::size_t>(rank)], rank);
        const std::byte* from = of_rank.data();
        own.for_each_own_cell(rank, [&](std::uint64_t cell, std::uint64_t) {
            const std::uint64_t count = (offsets[cell + 1] - offsets[cell]) * bytes;
            std::copy(from, from + count, all + offsets[cell] * bytes);
            from += count;
        });
    }
}

}  // namespace cellist::detail
