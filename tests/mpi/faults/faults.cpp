// SPDX-License-Identifier: MIT
// Where an OpenCL call fails on one rank, whichever it is, all ranks throw the same error, no rank
// hangs, and the lists then do the same work as ever.
#include "faults/layer.hpp"
#include "mpi/ranks.hpp"
#include "support/catch.hpp"
#include "support/storages.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

/// Calls a function on all ranks while the call `plan.call` of one rank fails. False if the rank
/// makes fewer calls.
bool fails(MPI_Comm comm, int failing_rank, const faults::Plan& plan,
           const std::function<void()>& call) {
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    if (rank == failing_rank) faults::arm(plan);
    const std::string text = common_error(comm, call);
    faults::disarm();
    int failed = rank == failing_rank && !faults::failures().empty() ? 1 : 0;
    MPI_Bcast(&failed, 1, MPI_INT, failing_rank, comm);
    // The library may do without memory that is missing. It never makes an error up.
    if (failed == 0) REQUIRE(text.empty());
    INFO(text);
    const std::string rank_text = "rank " + std::to_string(failing_rank) + ": ";
    // The C++ bindings have one name for all calls that retain objects.
    if (!text.empty())
        REQUIRE((text.starts_with(rank_text + "cl") || text.starts_with(rank_text + "Retain")));
    return failed == 1;
}

}  // namespace

TEST_CASE("an OpenCL call that fails on one rank fails on all ranks") {
    CELLIST_EACH_STORAGE(storage);
    (void)device();  // the loader loads layers at the first call
    REQUIRE(faults::loaded());
    CELLIST_RANDOM(random, 37u);
    const Shape shape{10, 10};
    const Inserts<Item> inserts = random_inserts(300, 100, random);
    const auto oracle = oracle_of(inserts, shape.cells());
    const int ranks = world_size();
    const mpi::Partition partition(MPI_COMM_WORLD, shape, {.ghosts = 1, .periodic = {true}});
    for (const auto code : {faults::Plan::Code::resources, faults::Plan::Code::object})
        // Each call fails on one of the ranks, in turn.
        for (std::uint64_t call = 1, missed = 0; missed < static_cast<std::uint64_t>(ranks);
             call += 5) {
            const int rank = static_cast<int>(call) % ranks;
            mpi::Lists<Item> lists(device(), partition, {.storage = storage, .capacity_nodes = 16});
            lists.core().set_message_bytes(100);
            lists.core().set_shares_memory(call % 2 == 0);
            DistributedInserter<Item> inserter(lists, inserts);
            INFO("call " << call << " of rank " << rank);
            const auto work = [&] {
                inserter.build(lists);
                lists.exchange_ghosts();
                lists.sort(&Item::key);
                (void)lists.lengths();
                (void)lists.validate();
                (void)lists.download();
            };
            const bool has_failed = fails(MPI_COMM_WORLD, rank, {.call = call, .code = code}, work);
            // The lists work as ever.
            require_complete(inserter.build(lists), inserts.size());
            lists.exchange_ghosts();
            REQUIRE(lists.validate().ok());
            require_same(lists.download(), oracle);
            missed = has_failed ? 0 : missed + 1;
        }
}

TEST_CASE("a device that is lost on one rank fails on all ranks") {
    const Shape shape{10, 10};
    CELLIST_RANDOM(random, 41u);
    const Inserts<Item> inserts = random_inserts(300, 100, random);
    for (std::uint64_t call = 1;; call += 7) {
        mpi::Lists<Item> lists(device(), mpi::Partition(MPI_COMM_WORLD, shape));
        DistributedInserter<Item> inserter(lists, inserts);
        INFO("call " << call);
        if (!fails(MPI_COMM_WORLD, world_size() - 1,
                   {.call = call, .extent = faults::Plan::Extent::lasting},
                   [&] { inserter.build(lists); }))
            return;
        require_complete(inserter.build(lists), inserts.size());
    }
}

TEST_CASE("lists that one rank cannot make are made on no rank") {
    for (std::uint64_t call = 1;; ++call) {
        INFO("call " << call);
        const mpi::Partition partition(MPI_COMM_WORLD, Shape{64});
        if (!fails(MPI_COMM_WORLD, 0, {.call = call},
                   [&] { const mpi::Lists<Item> lists(device(), partition); }))
            return;
    }
}
