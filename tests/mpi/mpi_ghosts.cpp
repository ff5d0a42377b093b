// SPDX-License-Identifier: MIT
// Ghost cells hold the records of the cells around a block, and kernels find them by their cells of
// the whole shape.
#include "mpi/ranks.hpp"
#include "support/catch.hpp"
#include "support/storages.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

using Position = std::array<std::int64_t, 4>;

/// The cell of the whole shape at a position that may be outside of it, if there is one.
std::optional<std::uint64_t> cell_at(const Shape& shape, const std::array<bool, 4>& periodic,
                                     Position at) {
    std::uint64_t cell = 0;
    for (std::size_t axis = 4; axis-- > 0;) {
        const auto extent = static_cast<std::int64_t>(shape.extent(axis));
        if (periodic[axis]) at[axis] = (at[axis] % extent + extent) % extent;
        if (at[axis] < 0 || at[axis] >= extent) return {};
        cell = cell * shape.extent(axis) + static_cast<std::uint64_t>(at[axis]);
    }
    return cell;
}

/// What a rank's lists must hold with their ghost cells.
Oracle<Item> oracle_with_ghosts(const mpi::Partition& partition, const Oracle<Item>& all) {
    Oracle<Item> oracle;
    const Shape local = partition.local_shape();
    const auto ghosts = partition.ghosts();
    for (std::uint64_t cell = 0; cell < local.cells(); ++cell) {
        Position at{};
        std::uint64_t rest = cell;
        for (std::size_t axis = 0; axis < 4; ++axis) {
            at[axis] = static_cast<std::int64_t>(rest % local.extent(axis) +
                                                 partition.block().origin[axis]) -
                       static_cast<std::int64_t>(ghosts[axis]);
            rest /= local.extent(axis);
        }
        const auto global = cell_at(partition.shape(), partition.options().periodic, at);
        if (!global) continue;
        const auto [begin, end] = all.equal_range(*global);
        for (auto entry = begin; entry != end; ++entry) oracle.emplace(cell, entry->second);
    }
    return oracle;
}

constexpr auto sum_source = R"(
#include <cellist/lists.clh>
// One work-item a cell of the whole shape: the sum of the ids of all records in the cells around.
kernel void sum_around(CELLIST_LISTS(Item, lists), global uint* sums, global uint* lengths,
                       uint radius)
{
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint sum = 0;
    cellist_for_each_around(lists, cell, radius, node) sum += cellist_get(lists, node).id + 1;
    sums[cell] = sum;
    uint own = 0;
    cellist_for_each(lists, cell, node) ++own;
    lengths[cell] = own == cellist_length(lists, cell) ? own : 12345u;
}
)";

/// Requires that a kernel that reads finds the lists of the block and around it.
void check_reading(const mpi::Lists<Item>& lists, const Oracle<Item>& all, cl_uint radius) {
    const mpi::Partition& partition = lists.partition();
    const std::uint64_t cells = partition.shape().cells();
    Buffer<cl_uint> sums(device(), cells), lengths(device(), cells);
    Kernel kernel(device(), sum_source, "sum_around", lists);
    kernel.run(Range::padded(cells), lists, sums, lengths, radius);
    const std::vector<cl_uint> found = sums.download(), found_lengths = lengths.download();
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
        if (partition.owner(cell) != partition.rank()) continue;
        Position at{};
        std::uint64_t rest = cell;
        for (std::size_t axis = 0; axis < 4; ++axis) {
            at[axis] = static_cast<std::int64_t>(rest % partition.shape().extent(axis));
            rest /= partition.shape().extent(axis);
        }
        // A cell counts once, also where the radius reaches around an axis.
        std::vector<std::uint64_t> around;
        const auto reach = static_cast<std::int64_t>(radius);
        Position off{};
        for (off[3] = -reach; off[3] <= reach; ++off[3])
            for (off[2] = -reach; off[2] <= reach; ++off[2])
                for (off[1] = -reach; off[1] <= reach; ++off[1])
                    for (off[0] = -reach; off[0] <= reach; ++off[0])
                        if (const auto other = cell_at(
                                partition.shape(), partition.options().periodic,
                                {at[0] + off[0], at[1] + off[1], at[2] + off[2], at[3] + off[3]}))
                            around.push_back(*other);
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        cl_uint sum = 0;
        for (const std::uint64_t other : around) {
            const auto [begin, end] = all.equal_range(other);
            for (auto entry = begin; entry != end; ++entry) sum += entry->second.id + 1;
        }
        REQUIRE(found[cell] == sum);
        REQUIRE(found_lengths[cell] == all.count(cell));
    }
}

struct Case {
    Shape shape;
    mpi::PartitionOptions options;
};

}  // namespace

TEST_CASE("ghost cells hold the records of the cells around a block") {
    CELLIST_EACH_STORAGE(storage);
    const Case given = GENERATE(
        Case{{40}, {.ghosts = 1, .periodic = {}, .blocks = {}}},
        Case{{40}, {.ghosts = 3, .periodic = {true}, .blocks = {}}},
        Case{{16, 16}, {.ghosts = 1, .periodic = {true, false}, .blocks = {}}},
        Case{{16, 16}, {.ghosts = 2, .periodic = {true, true}, .blocks = {}}},
        Case{{8, 8, 8}, {.ghosts = 1, .periodic = {true, true, true}, .blocks = {}}},
        Case{{8, 8, 8}, {.ghosts = 2, .periodic = {false, true, false}, .blocks = {}}},
        Case{{4, 5, 4, 6}, {.ghosts = 1, .periodic = {true, false, true, true}, .blocks = {}}});
    INFO("shape " << given.shape.to_string() << ", " << given.options.ghosts << " layers");
    CELLIST_RANDOM(random, 23u);
    const Inserts<Item> inserts =
        random_inserts(1200, static_cast<std::uint32_t>(given.shape.cells()), random);
    const auto oracle = oracle_of(inserts, given.shape.cells());
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        const mpi::Partition partition(comm, given.shape, given.options);
        mpi::Lists<Item> lists(device(), partition, {.storage = storage});
        DistributedInserter<Item> inserter(lists, inserts);
        for (int build = 0; build < 2; ++build) {
            inserter.build(lists);
            const auto expected = oracle_with_ghosts(partition, oracle);
            // The second exchange replaces the ghost cells.
            for (int exchange = 0; exchange < 2; ++exchange) {
                const BuildReport report = lists.exchange_ghosts();
                REQUIRE(report.existing == inserts.size());
                REQUIRE(report.existing + report.attempted == report.stored);
                REQUIRE(report.dropped + report.rejected == 0);
                require_same(lists.local().download(), expected);
            }
            REQUIRE(lists.validate().ok());
            REQUIRE(lists.lengths().total == inserts.size());
            require_same(lists.download(), oracle);
        }
        check_reading(lists, oracle, given.options.ghosts);
    });
}

TEST_CASE("cells of the whole shape and of a rank's lists convert into each other") {
    const Shape shape{9, 8, 7};
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        const mpi::Partition partition(
            comm, shape, {.ghosts = 1, .periodic = {true, false, true}, .blocks = {}});
        std::uint64_t own = 0;
        for (std::uint64_t cell = 0; cell < shape.cells(); ++cell) {
            const auto local = partition.local_cell(cell);
            REQUIRE(local.has_value() == (partition.owner(cell) == partition.rank()));
            if (!local) continue;
            ++own;
            REQUIRE(partition.cell(*local) == cell);
        }
        REQUIRE(own == partition.block().cells());
        std::uint64_t named = 0;
        for (std::uint64_t local = 0; local < partition.local_shape().cells() + 5; ++local)
            if (partition.cell(local)) ++named;
        REQUIRE(named == own);
        std::uint64_t all = 0;
        for (int rank = 0; rank < ranks; ++rank) all += partition.block(rank).cells();
        REQUIRE(all == shape.cells());
    });
}
