// SPDX-License-Identifier: MIT
// Sorted lists are the same for any number of ranks, and the report is exact.
#include "mpi/ranks.hpp"
#include "support/catch.hpp"

using namespace cellist;
using namespace cellist::test;

TEST_CASE("sorted lists are the same for any number of ranks") {
    CELLIST_RANDOM(random, 7u);
    const Shape shape{12, 9};
    const Inserts<Item> inserts = random_inserts(4096, 120, random);
    const auto oracle = oracle_of(inserts, shape.cells());
    std::vector<Item> first;
    with_all_counts([&](MPI_Comm comm, int ranks) {
        const mpi::Partition partition(comm, shape);
        mpi::Lists<Item> lists(device(), partition);
        DistributedInserter<Item> inserter(lists, inserts);
        const BuildReport report = inserter.build(lists);
        CHECK(report.attempted == inserts.size());
        CHECK(report.stored == oracle.size());
        CHECK(report.rejected == inserts.size() - oracle.size());
        CHECK(report.dropped == 0);
        lists.sort(&Item::key);
        const HostLists<Item> found = lists.download();
        require_same(found, oracle);
        if (ranks == 1) first = found.records();
        if (world_rank() == 0) CHECK(found.records() == first);
        CHECK(lists.validate().ok());
        CHECK(lists.lengths().total == oracle.size());
    });
}
