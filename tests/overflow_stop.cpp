// SPDX-License-Identifier: MIT
// Overflow::stop throws where the pool is too small, and nothing half-built stays readable.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

TEST_CASE("stop throws the report of the failed build and leaves the lists empty and usable") {
    CELLIST_RANDOM(random, 40u);
    for (const std::uint64_t capacity : {0u, 1u, 92u, 143u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(device(), {50}, {.overflow = Overflow::stop, .capacity_nodes = capacity});
        Inserter inserter(lists);
        Inserts<Item> inserts = random_inserts(144, 50, random);
        inserts.add(50, {0.0f, 144});

        const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
        INFO(error.what());
        REQUIRE(contains(error.what(), std::to_string(capacity)));
        REQUIRE(contains(error.what(), "144"));
        REQUIRE(error.report().attempted == 145);
        REQUIRE(error.report().stored == capacity);
        REQUIRE(error.report().dropped == 144 - capacity);
        REQUIRE(error.report().rejected == 1);
        REQUIRE(error.report().passes == 1);
        REQUIRE(error.report().capacity_nodes == capacity);

        REQUIRE(lists.capacity_nodes() == capacity);
        require_sound(lists, 0);
        REQUIRE(lists.download().records().empty());
        REQUIRE(lists.lengths().nonempty_cells == 0);

        const Inserts<Item> fewer = random_inserts(capacity, 50, random);
        require_complete(inserter.build(lists, fewer), capacity);
        require_same(lists.download(), oracle_of(fewer, 50));
    }
}

TEST_CASE("stop accepts a demand of exactly the capacity") {
    CELLIST_RANDOM(random, 41u);
    for (const cl_uint demand : {0u, 1u, 255u, 256u, 4096u, 5000u}) {
        Lists<Item> lists(device(), {50}, {.overflow = Overflow::stop, .capacity_nodes = demand});
        const Inserts<Item> inserts = random_inserts(demand, 50, random);
        require_complete(Inserter(lists).build(lists, inserts), demand);
        require_sound(lists, demand);
        require_same(lists.download(), oracle_of(inserts, 50));
    }
}

TEST_CASE("stop and drop need a capacity") {
    for (const Overflow overflow : {Overflow::stop, Overflow::drop}) {
        const auto error = error_of([&] { Lists<Item>(device(), {5}, {.overflow = overflow}); });
        INFO(error.what());
        REQUIRE(contains(error.what(), "capacity_nodes"));
    }
}

}  // namespace
}  // namespace cellist::test
