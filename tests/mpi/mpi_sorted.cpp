// SPDX-License-Identifier: MIT
// Sorted lists are the same to the bit for any number of ranks and any division of the cells.
#include "mpi/ranks.hpp"
#include "support/catch.hpp"
#include "support/storages.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

constexpr std::size_t count = 1500;

/// What one device makes of the inserts.
HostLists<Item> on_one_device(const Shape& shape, const Inserts<Item>& inserts) {
    Lists<Item> lists(device(), shape);
    Inserter<Item>(lists).build(lists, inserts);
    lists.sort(&Item::key);
    return lists.download();
}

void require_same_lists(const HostLists<Item>& found, const HostLists<Item>& expected) {
    REQUIRE(found.offsets() == expected.offsets());
    REQUIRE(found.records() == expected.records());
}

void check(const mpi::Partition& partition, const ListsOptions& options,
           const Inserts<Item>& inserts, const HostLists<Item>& expected,
           std::uint64_t message_bytes = 0, bool shares_memory = true) {
    mpi::Lists<Item> lists(device(), partition, options);
    if (message_bytes > 0) lists.core().set_message_bytes(message_bytes);
    lists.core().set_shares_memory(shares_memory);
    DistributedInserter<Item> inserter(lists, inserts);
    // The second build finds the room that the first has made.
    for (int build = 0; build < 2; ++build) {
        const BuildReport report = inserter.build(lists);
        require_complete(report, expected.records().size(),
                         inserts.size() - expected.records().size());
        lists.sort(&Item::key);
        require_same_lists(lists.download(), expected);
    }
    REQUIRE(lists.validate().ok());
    const Lengths lengths = lists.lengths();
    REQUIRE(lengths.total == expected.records().size());
    std::uint64_t cells = 0;
    for (const auto& [length, number] : lengths.histogram) cells += number;
    REQUIRE(cells == expected.cells());
}

}  // namespace

TEST_CASE("sorted lists are the same for any number of ranks") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 7u);
    const Shape shape = GENERATE(Shape{1}, Shape{53}, Shape{12, 9}, Shape{5, 4, 7},
                                 Shape{3, 4, 2, 5}, Shape{16, 1, 3});
    INFO("shape " << shape.to_string());
    const auto all = static_cast<std::uint32_t>(shape.cells());
    const Inserts<Item> inserts = random_inserts(count, all + all / 8, random);
    const HostLists<Item> expected = on_one_device(shape, inserts);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        check(mpi::Partition(comm, shape), {.storage = storage}, inserts, expected);
    });
}

TEST_CASE("the division of the cells does not change sorted lists") {
    CELLIST_RANDOM(random, 11u);
    const Shape shape{6, 5, 4, 3};
    const Inserts<Item> inserts =
        random_inserts(count, static_cast<std::uint32_t>(shape.cells()), random);
    const HostLists<Item> expected = on_one_device(shape, inserts);
    using Blocks = std::array<std::uint32_t, 4>;
    for (const Blocks& blocks :
         {Blocks{2, 1, 1, 1}, Blocks{1, 3, 1, 1}, Blocks{2, 2, 1, 1}, Blocks{1, 1, 4, 1},
          Blocks{1, 1, 1, 5}, Blocks{3, 2, 1, 1}, Blocks{1, 1, 2, 3}, Blocks{2, 2, 2, 1},
          Blocks{2, 2, 1, 2}, Blocks{1, 1, 1, 8}, Blocks{8, 1, 1, 1}}) {
        const auto ranks = static_cast<int>(blocks[0] * blocks[1] * blocks[2] * blocks[3]);
        if (ranks > world_size()) continue;
        with_ranks(ranks, [&](MPI_Comm comm) {
            INFO("blocks " << blocks[0] << "x" << blocks[1] << "x" << blocks[2] << "x"
                           << blocks[3]);
            const mpi::Partition partition(comm, shape, {.blocks = blocks});
            REQUIRE(partition.block().cells() <= shape.cells());
            check(partition, {}, inserts, expected);
        });
    }
}

TEST_CASE("a balanced partition has about as many records on each rank") {
    CELLIST_RANDOM(random, 13u);
    const Shape shape{24, 16};
    // Most records are in a corner.
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 4096; ++i) {
        const std::uint32_t x = below(random, 24) * below(random, 24) / 24;
        const std::uint32_t y = below(random, 16) * below(random, 16) / 16;
        inserts.add(y * 24 + x, {static_cast<cl_float>(below(random, 100)), i});
    }
    const HostLists<Item> expected = on_one_device(shape, inserts);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        int rank = 0;
        MPI_Comm_rank(comm, &rank);
        std::vector<std::uint64_t> weights(shape.cells(), 0);
        for (const cl_uint cell : share_of(inserts, rank, ranks).cells) ++weights[cell];
        const auto partition = mpi::Partition::balanced(comm, shape, weights);
        check(partition, {}, inserts, expected);
        std::uint64_t own = 0;
        for (std::uint64_t cell = 0; cell < shape.cells(); ++cell)
            if (partition.owner(cell) == partition.rank()) own += expected.cell(cell).size();
        REQUIRE(own < 2 * inserts.size() / static_cast<std::size_t>(ranks));
    });
}

TEST_CASE("a partition without any weight has blocks of about equal size") {
    const Shape shape{48};
    with_all_counts([&](MPI_Comm comm, int ranks) {
        const auto partition =
            mpi::Partition::balanced(comm, shape, std::vector<std::uint64_t>(shape.cells(), 0));
        for (int rank = 0; rank < ranks; ++rank)
            REQUIRE(partition.block(rank).cells() >= 48 / static_cast<std::uint64_t>(ranks) - 1);
    });
}

TEST_CASE("records travel in any number of messages, or of pieces of shared memory") {
    CELLIST_RANDOM(random, 17u);
    const Shape shape{12, 9};
    const Inserts<Item> inserts = random_inserts(count, 108, random);
    const HostLists<Item> expected = on_one_device(shape, inserts);
    for (const std::uint64_t bytes : {12u, 60u, 100u, 4096u})
        with_all_counts([&](MPI_Comm comm, int ranks) {
            for (const bool shares : {false, true}) {
                INFO(ranks << " ranks, " << (shares ? "pieces" : "messages") << " of " << bytes
                           << " bytes");
                check(mpi::Partition(comm, shape), {}, inserts, expected, bytes, shares);
            }
        });
}

TEST_CASE("an outbox grows to what a build needs") {
    const Shape shape{16};
    Inserts<Item> inserts;
    // All for the cells of the last rank.
    for (cl_uint i = 0; i < 200'000; ++i) inserts.add(15, {static_cast<cl_float>(i % 97), i});
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        mpi::Lists<Item> lists(device(), mpi::Partition(comm, shape));
        DistributedInserter<Item> inserter(lists, inserts);
        for (int build = 0; build < 2; ++build)
            require_complete(inserter.build(lists), inserts.size());
        REQUIRE(lists.lengths().longest == inserts.size());
    });
}

TEST_CASE("the nearest records and an automatic storage are those of one device") {
    CELLIST_RANDOM(random, 19u);
    const Shape shape{7, 6};
    const Inserts<Item> inserts = random_inserts(count, 42, random);
    Lists<Item> one(device(), shape, {.storage = nearest(&Item::key, 5)});
    const BuildReport whole = Inserter<Item>(one).build(one, inserts);
    one.sort(&Item::key);
    const HostLists<Item> nearest_of_one = one.download();
    const HostLists<Item> all_of_one = on_one_device(shape, inserts);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        const mpi::Partition partition(comm, shape);
        mpi::Lists<Item> nearest_lists(device(), partition, {.storage = nearest(&Item::key, 5)});
        DistributedInserter<Item> inserter(nearest_lists, inserts);
        const BuildReport report = inserter.build(nearest_lists);
        REQUIRE(report.attempted == whole.attempted);
        REQUIRE(report.stored == whole.stored);
        REQUIRE(report.dropped == whole.dropped);
        nearest_lists.sort(&Item::key);
        require_same_lists(nearest_lists.download(), nearest_of_one);

        mpi::Lists<Item> automatic(device(), partition, {.storage = Storage::automatic});
        DistributedInserter<Item> into_automatic(automatic, inserts);
        for (int build = 0; build < 6; ++build)
            require_complete(into_automatic.build(automatic), inserts.size());
        automatic.sort(&Item::key);
        require_same_lists(automatic.download(), all_of_one);
    });
}

TEST_CASE("records may be scalars") {
    constexpr auto source = R"(
#include <cellist/lists.clh>
kernel void divide(CELLIST_LISTS(uint, numbers), uint first, uint step)
{
    const uint number = first + get_global_id(0) * step;
    if (number < 1000) cellist_insert(numbers, number % 7, number);
}
)";
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        const mpi::Partition partition(comm, Shape{7});
        mpi::Lists<cl_uint> numbers(device(), partition);
        Kernel kernel(device(), source, "divide", numbers);
        const BuildReport report =
            numbers.build(kernel, Range(1000), static_cast<cl_uint>(partition.rank()),
                          static_cast<cl_uint>(ranks));
        REQUIRE(report.stored == 1000);
        numbers.sort();
        const HostLists<cl_uint> found = numbers.download();
        for (std::uint64_t cell = 0; cell < 7; ++cell)
            for (std::size_t i = 0; i < found.cell(cell).size(); ++i)
                REQUIRE(found.cell(cell)[i] == cell + 7 * i);
    });
}
