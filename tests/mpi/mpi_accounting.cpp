// SPDX-License-Identifier: MIT
// The report of a build over several ranks is exact, under each policy, in each storage, through
// shared memory and in messages.
#include "mpi/ranks.hpp"
#include "support/catch.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

Shape random_shape(std::mt19937& random) {
    switch (below(random, 4)) {
        case 0:
            return {below(random, 60)};
        case 1:
            return {below(random, 12), 1 + below(random, 12)};
        case 2:
            return {1 + below(random, 6), 1 + below(random, 6), 1 + below(random, 6)};
        default:
            return {1 + below(random, 4), 1 + below(random, 4), 1 + below(random, 4),
                    1 + below(random, 4)};
    }
}

}  // namespace

TEST_CASE("attempted records are stored, dropped or rejected, in 1000 random cases") {
    for (cl_uint number = 0; number < 1000; ++number) {
        CELLIST_RANDOM(random, number);
        // All ranks draw the same numbers.
        const int ranks = 2 + static_cast<int>(below(random, 4));
        const Shape shape = random_shape(random);
        ListsOptions options{.storage = all_storages[below(random, all_storages.size())],
                             .overflow = static_cast<Overflow>(below(random, 3))};
        if (options.overflow != Overflow::grow || below(random, 2) == 0) {
            options.capacity_nodes = below(random, 600);
            options.slots = 1 + below(random, 12);
        }
        const std::size_t count = below(random, 1200);
        const auto cells = static_cast<std::uint32_t>(shape.cells());
        const Inserts<Item> inserts = random_inserts(count, 1 + cells + below(random, 10), random);
        const std::uint64_t message_bytes = std::uint64_t{12} << below(random, 21);
        if (ranks > world_size()) continue;
        with_ranks(ranks, [&](MPI_Comm comm) {
            INFO("case " << number << ", " << ranks << " ranks, shape " << shape.to_string() << ", "
                         << name_of(options.storage) << ", policy "
                         << static_cast<int>(options.overflow));
            const auto oracle = oracle_of(inserts, shape.cells());
            const mpi::Partition partition(comm, shape);
            for (const bool shares : {true, false}) {
                INFO("memory is " << (shares ? "" : "not ") << "shared");
                mpi::Lists<Item> lists(device(), partition, options);
                lists.core().set_shares_memory(shares);
                lists.core().set_message_bytes(message_bytes);
                DistributedInserter<Item> inserter(lists, inserts);
                BuildReport report;
                bool is_full = false;
                try {
                    report = inserter.build(lists);
                } catch (const OverflowError&) {
                    is_full = true;
                }
                int full = is_full ? 1 : 0, all = 0;
                MPI_Allreduce(&full, &all, 1, MPI_INT, MPI_SUM, comm);
                REQUIRE((all == 0 || all == ranks));
                if (is_full) {
                    REQUIRE(options.overflow == Overflow::stop);
                    REQUIRE(lists.lengths().total == 0);
                    continue;
                }
                REQUIRE(report.attempted == inserts.size());
                REQUIRE(report.rejected == inserts.size() - oracle.size());
                REQUIRE(report.stored + report.dropped == oracle.size());
                if (options.overflow != Overflow::drop) REQUIRE(report.dropped == 0);
                REQUIRE(lists.lengths().total == report.stored);
                REQUIRE(lists.validate().ok());
            }
        });
    }
}
