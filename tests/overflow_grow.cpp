// SPDX-License-Identifier: MIT
// Overflow::grow enlarges the pool to the exact demand and runs the kernels again.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

TEST_CASE("a pool that is too small grows to the exact demand in a second pass") {
    CELLIST_RANDOM(random, 30u);
    for (const std::uint64_t capacity : {0u, 1u, 92u, 1000u, 4095u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(device(), {50}, {.capacity_nodes = capacity});
        REQUIRE(lists.capacity_nodes() == capacity);
        Inserter inserter(lists);
        const Inserts<Item> inserts = random_inserts(4096, 60, random);
        const Oracle<Item> oracle = oracle_of(inserts, 50);

        const BuildReport report = inserter.build(lists, inserts);
        require_complete(report, oracle.size(), 4096 - oracle.size());
        const bool fits = capacity >= oracle.size();
        REQUIRE(report.passes == (fits ? 1 : 2));
        REQUIRE(report.capacity_nodes == (fits ? capacity : oracle.size()));
        REQUIRE(lists.capacity_nodes() == report.capacity_nodes);
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);

        REQUIRE(inserter.build(lists, inserts).passes == 1);
    }
}

TEST_CASE("a pool that is one node too small grows by one node") {
    CELLIST_RANDOM(random, 31u);
    for (const cl_uint demand : {1u, 256u, 257u, 4097u}) {
        Lists<Item> lists(device(), {3}, {.capacity_nodes = demand - 1});
        const BuildReport report = Inserter(lists).build(lists, random_inserts(demand, 3, random));
        require_complete(report, demand);
        REQUIRE(report.passes == 2);
        REQUIRE(report.capacity_nodes == demand);
        require_sound(lists, demand);
    }
}

TEST_CASE("the pool keeps its capacity when the demand falls") {
    CELLIST_RANDOM(random, 32u);
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 1});
    Inserter inserter(lists);
    inserter.build(lists, random_inserts(4096, 50, random));
    const BuildReport report = inserter.build(lists, random_inserts(7, 50, random));
    require_complete(report, 7);
    REQUIRE(report.capacity_nodes == 4096);
    REQUIRE(report.passes == 1);
}

TEST_CASE("all kernels of a build run again after the pool has grown") {
    CELLIST_RANDOM(random, 33u);
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 10});
    Inserter inserter(lists);
    const Inserts<Item> first = random_inserts(100, 50, random);
    const Inserts<Item> second = random_inserts(93, 50, random);
    int calls = 0;
    const BuildReport report = lists.build([&] {
        ++calls;
        inserter.run(lists, first);
        inserter.run(lists, second);
    });
    require_complete(report, 193);
    REQUIRE(calls == 2);
    REQUIRE(report.passes == 2);
    Oracle<Item> oracle = oracle_of(first, 50);
    oracle.merge(oracle_of(second, 50));
    require_same(lists.download(), oracle);
}

TEST_CASE("the budget bounds how far a pool grows") {
    CELLIST_RANDOM(random, 34u);
    const std::uint64_t exact = Lists<Item>(device(), {50}, {.capacity_nodes = 4096}).pool_bytes();
    const Inserts<Item> inserts = random_inserts(4096, 50, random);

    Lists<Item> fits(device(), {50}, {.capacity_nodes = 10, .budget_bytes = exact});
    require_complete(Inserter(fits).build(fits, inserts), 4096);
    REQUIRE(fits.pool_bytes() <= exact);

    Lists<Item> lists(device(), {50}, {.capacity_nodes = 10, .budget_bytes = exact - 1});
    Inserter inserter(lists);
    const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
    INFO(error.what());
    REQUIRE(contains(error.what(), std::to_string(exact - 1)));
    REQUIRE(contains(error.what(), std::to_string(exact)));
    REQUIRE(error.report().attempted == 4096);
    REQUIRE(error.report().stored == 10);
    REQUIRE(error.report().dropped == 4086);

    require_sound(lists, 0);
    REQUIRE(lists.capacity_nodes() == 10);
    require_complete(inserter.build(lists, random_inserts(3000, 50, random)), 3000);
    require_sound(lists, 3000);
}

TEST_CASE("a container that does not fit its budget is refused") {
    const auto error =
        error_of([] { Lists<Item>(device(), {50}, {.capacity_nodes = 100, .budget_bytes = 999}); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "999"));
}

TEST_CASE("a kernel that inserts more in every pass ends in an error") {
    CELLIST_RANDOM(random, 35u);
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 10});
    Inserter inserter(lists);
    cl_uint count = 0;
    const auto error = error_of<OverflowError>([&] {
        lists.build([&] {
            count += 100;
            inserter.run(lists, random_inserts(count, 50, random));
        });
    });
    INFO(error.what());
    REQUIRE(contains(error.what(), "same records every time"));
    require_sound(lists, 0);
    const Inserts<Item> inserts = random_inserts(5000, 50, random);
    require_complete(inserter.build(lists, inserts), 5000);
    require_same(lists.download(), oracle_of(inserts, 50));
}

TEST_CASE("a kernel that inserts less in the second pass is reported as it ran") {
    CELLIST_RANDOM(random, 36u);
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 10});
    Inserter inserter(lists);
    const Inserts<Item> many = random_inserts(200, 50, random);
    const Inserts<Item> few = random_inserts(20, 50, random);
    int calls = 0;
    const BuildReport report = lists.build([&] { inserter.run(lists, ++calls == 1 ? many : few); });
    require_complete(report, 20);
    REQUIRE(report.capacity_nodes == 200);
    require_same(lists.download(), oracle_of(few, 50));
}

TEST_CASE("an exception out of the inserting code leaves the lists empty and usable") {
    CELLIST_RANDOM(random, 37u);
    Lists<Item> lists(device(), {50});
    Inserter inserter(lists);
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    REQUIRE_THROWS_AS(lists.build([&] {
        inserter.run(lists, inserts);
        throw std::runtime_error("the caller's own");
    }),
                      std::runtime_error);
    require_sound(lists, 0);
    require_complete(inserter.build(lists, inserts), 144);
    require_same(lists.download(), oracle_of(inserts, 50));
}

}  // namespace
}  // namespace cellist::test
