// SPDX-License-Identifier: MIT
// Wrong input is refused on all ranks with the same message, and what fails on one rank fails on
// all.
#include "mpi/ranks.hpp"
#include "support/catch.hpp"
#include "support/storages.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

bool contains(const std::string& text, const std::string& part) {
    INFO("'" << text << "' contains '" << part << "'");
    CHECK(text.find(part) != std::string::npos);
    return text.find(part) != std::string::npos;
}

/// Another record than Item.
struct Other {
    cl_uint id;
};
CELLIST_STRUCT(Other, id);

int rank_of(MPI_Comm comm) {
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    return rank;
}

}  // namespace

TEST_CASE("all ranks refuse different shapes, and name both") {
    with_all_counts([&](MPI_Comm comm, int ranks) {
        if (ranks == 1) return;
        const std::string text = common_error(comm, [&] {
            const std::uint64_t width = rank_of(comm) == ranks - 1 ? 32 : 64;
            const mpi::Partition partition(comm, Shape{width, 64});
        });
        contains(text, "rank 0 has the shape 64x64");
        contains(text, "rank " + std::to_string(ranks - 1) + " has the shape 32x64");
    });
}

TEST_CASE("all ranks refuse different options and records") {
    with_all_counts([&](MPI_Comm comm, int ranks) {
        if (ranks == 1) return;
        const mpi::Partition partition(comm, Shape{16});
        contains(common_error(comm,
                              [&] {
                                  const auto ghosts = rank_of(comm) == 0 ? 1U : 2U;
                                  const mpi::Partition other(comm, Shape{64}, {.ghosts = ghosts});
                              }),
                 "different partitions");
        contains(common_error(comm,
                              [&] {
                                  const Storage storage =
                                      rank_of(comm) == 0 ? Storage::linked : Storage::counted;
                                  const mpi::Lists<Item> lists(device(), partition,
                                                               {.storage = storage});
                              }),
                 "Storage::counted");
        const std::string text = common_error(comm, [&] {
            if (rank_of(comm) == 0)
                const mpi::Lists<Item> lists(device(), partition);
            else
                const mpi::Lists<Other> lists(device(), partition);
        });
        contains(text, "rank 0 has lists of struct Item");
        contains(text, "rank 1 has lists of struct Other");
    });
}

TEST_CASE("ranks that make different calls throw, and go on") {
    with_all_counts([&](MPI_Comm comm, int ranks) {
        if (ranks == 1) return;
        const mpi::Partition partition(comm, Shape{40}, {.ghosts = 1});
        mpi::Lists<Item> lists(device(), partition);
        const bool is_first = rank_of(comm) == 0;
        const std::string calls = common_error(comm, [&] {
            if (is_first)
                (void)lists.lengths();
            else
                lists.exchange_ghosts();
        });
        contains(calls, "rank 0 has lengths, rank 1 has exchange_ghosts");
        const std::string keys = common_error(comm, [&] {
            if (is_first)
                lists.sort(&Item::key);
            else
                lists.sort(&Item::id);
        });
        contains(keys, "rank 0 has sort by key, ascending, rank 1 has sort by id, ascending");
        CHECK(lists.lengths().total == 0);
    });
}

TEST_CASE("a partition is refused if its blocks do not fit") {
    with_all_counts([&](MPI_Comm comm, int ranks) {
        const auto count = static_cast<std::uint32_t>(ranks);
        contains(
            common_error(
                comm,
                [&] {
                    const mpi::Partition partition(comm, Shape{64, 64}, {.blocks = {count, 2}});
                }),
            "must be the number of ranks");
        const std::string wide = common_error(
            comm, [&] { const mpi::Partition partition(comm, Shape{12}, {.ghosts = 13}); });
        if (ranks > 1)
            contains(wide, "13 layers of ghost cells would be wider than the block of rank");
        const std::string around = common_error(comm, [&] {
            const mpi::Partition partition(comm, Shape{2}, {.ghosts = 1, .periodic = {true}});
        });
        if (ranks > 1) contains(around, "meet around the 2 cells along x");
        contains(common_error(comm,
                              [&] {
                                  const std::size_t weights = rank_of(comm) == ranks - 1 ? 3 : 4;
                                  const auto partition = mpi::Partition::balanced(
                                      comm, Shape{4}, std::vector<std::uint64_t>(weights, 1));
                              }),
                 "needs one for each cell");
    });
    CHECK_THROWS_AS(mpi::Partition(MPI_COMM_NULL, Shape{4}), Error);
}

TEST_CASE("ghost cells and periodic axes are those of the partition") {
    with_all_counts([&](MPI_Comm comm, int) {
        const mpi::Partition partition(comm, Shape{16});
        mpi::Lists<Item> lists(device(), partition);
        contains(common_error(comm, [&] { lists.exchange_ghosts(); }), "without ghost cells");
        contains(common_error(comm,
                              [&] {
                                  const mpi::Lists<Item> periodic(device(), partition,
                                                                  {.periodic = {true}});
                              }),
                 "PartitionOptions::periodic");
    });
}

TEST_CASE("what a kernel's function throws on one rank, all ranks throw") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 29u);
    const Inserts<Item> inserts = random_inserts(400, 40, random);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        mpi::Lists<Item> lists(device(), mpi::Partition(comm, Shape{40}), {.storage = storage});
        DistributedInserter<Item> inserter(lists, inserts);
        // In the first run of the kernels, and in a later one, if there is one.
        for (int failing_run = 1; failing_run <= 2; ++failing_run) {
            inserter.build(lists);
            int runs = 0;
            const std::string text = common_error(comm, [&] {
                lists.build([&] {
                    if (++runs == failing_run && rank_of(comm) == ranks - 1)
                        throw std::runtime_error("no more photons");
                    inserter.run(lists);
                });
            });
            if (text.empty()) {
                CHECK(failing_run == 2);
                CHECK(lists.lengths().total == inserts.size());
                continue;
            }
            if (ranks > 1) CHECK(text == "rank " + std::to_string(ranks - 1) + ": no more photons");
            CHECK(lists.lengths().total == 0);
            require_complete(inserter.build(lists), inserts.size());
        }
    });
}

TEST_CASE("a pool that is too small on one rank stops all ranks") {
    const Shape shape{16};
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 300; ++i) inserts.add(15, {1.0f, i});
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        mpi::Lists<Item> lists(device(), mpi::Partition(comm, shape),
                               {.overflow = Overflow::stop, .capacity_nodes = 100});
        DistributedInserter<Item> inserter(lists, inserts);
        bool is_overflow = false;
        const std::string text = common_error(comm, [&] {
            try {
                inserter.build(lists);
            } catch (const OverflowError& error) {
                is_overflow = true;
                CHECK(error.report().stored + error.report().dropped == 300);
                throw;
            }
        });
        CHECK(is_overflow);
        contains(text, "the pool of 100 nodes is too small for 300 records");
        if (ranks > 1) contains(text, "rank " + std::to_string(ranks - 1) + ": ");
        CHECK(lists.lengths().total == 0);
    });
}

TEST_CASE("ranks may have no records, and partitions more ranks than cells") {
    const Shape shape{2};
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 50; ++i) inserts.add(i % 3, {1.0f, i});
    const auto oracle = oracle_of(inserts, 2);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        const mpi::Partition partition(comm, shape);
        mpi::Lists<Item> lists(device(), partition);
        Inserts<Item> mine;
        if (rank_of(comm) == ranks - 1) mine = inserts;
        const Buffer<cl_uint> cells(device(), mine.cells);
        const Buffer<Item> records(device(), mine.records);
        Kernel kernel(device(), insert_source("Item"), "insert_all", lists);
        const auto count = static_cast<cl_uint>(mine.size());
        const BuildReport report = lists.build([&] {
            if (count > 0) kernel
                .run(Range::padded(count, 64), lists, cells, records, count);
        });
        require_complete(report, oracle.size(), inserts.size() - oracle.size());
        require_same(lists.download(), oracle);
        lists.clear();
        CHECK(lists.lengths().total == 0);
        const mpi::Partition none(comm, Shape{0, 3});
        mpi::Lists<Item> empty(device(), none);
        DistributedInserter<Item> inserter(empty, inserts);
        require_complete(inserter.build(empty), 0, inserts.size());
    });
}

TEST_CASE("inserts outside of a build are counted on all ranks") {
    CELLIST_RANDOM(random, 31u);
    const Inserts<Item> inserts = random_inserts(93, 40, random);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        mpi::Lists<Item> lists(device(), mpi::Partition(comm, Shape{40}));
        DistributedInserter<Item> inserter(lists, inserts);
        inserter.build(lists);
        inserter.run(lists);
        const Validation validation = lists.validate();
        CHECK(validation.late_inserts == inserts.size());
        CHECK(lists.lengths().total == inserts.size());
    });
}

TEST_CASE("a kernel takes distributed lists and others") {
    constexpr auto source = R"(
#include <cellist/lists.clh>
kernel void both(CELLIST_LISTS(Item, some), CELLIST_LISTS(Item, far), CELLIST_LISTS(Item, near),
                 uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_for_each(some, i % 4, node) cellist_insert(far, i % 16, cellist_get(some, node));
    cellist_insert(near, i % 8, (Item){2.0f, i});
}
)";
    Lists<Item> some(device(), Shape{4}), near(device(), Shape{8});
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 4; ++i) inserts.add(i, {1.0f, i});
    Inserter<Item>(some).build(some, inserts);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        mpi::Lists<Item> far(device(), mpi::Partition(comm, Shape{16}));
        Kernel kernel(device(), source, "both", some, far, near);
        const BuildReport report = far.build([&] {
            const BuildReport inner =
                near.build([&] { kernel.run(Range::padded(64), some, far, near, cl_uint{64}); });
            require_complete(inner, 64);
        });
        require_complete(report, 64 * static_cast<std::uint64_t>(ranks));
    });
}
