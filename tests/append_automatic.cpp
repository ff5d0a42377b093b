// SPDX-License-Identifier: MIT
// Storage::automatic keeps records where an append makes it leave a storage.
#include "support/appends.hpp"
#include "support/internals.hpp"

namespace cellist::test {
namespace {

TEST_CASE("automatic lists take appends between all builds of a trial") {
    CELLIST_RANDOM(random, 430u);
    for (const Overflow overflow : {Overflow::grow, Overflow::stop, Overflow::drop}) {
        Lists<Item> lists(device(), {50},
                          {.storage = Storage::automatic,
                           .overflow = overflow,
                           .capacity_nodes = 5000,
                           .slots = 300});
        Inserter inserter(lists);
        for (int again = 0; again < 16; ++again) {
            const Inserts<Item> first = random_inserts(2000, 50, random);
            const Inserts<Item> second = random_inserts(144, 60, random);
            require_complete(inserter.build(lists, first), 2000);
            Oracle<Item> oracle = oracle_of(first, 50);
            oracle.merge(oracle_of(second, 50));
            const Storage before = lists.storage();
            const BuildReport report = append(inserter, lists, second);
            REQUIRE(report.existing == 2000);
            REQUIRE(report.attempted == 144);
            REQUIRE(report.stored == oracle.size());
            REQUIRE(lists.storage() == before);
            require_sound(lists, oracle.size());
            require_same(lists.download(), oracle);
        }
    }
}

/// Lists whose trial has reached a storage, with these records.
Lists<Item> lists_in(Storage storage, Inserter<Item>& inserter, const Inserts<Item>& inserts,
                     Overflow overflow) {
    Lists<Item> lists(device(), {2000},
                      {.storage = Storage::automatic,
                       .overflow = overflow,
                       .capacity_nodes = 200'000,
                       .slots = 4});
    while (tuner_of(lists)->storage() != storage)
        tuner_of(lists)->measured({{1e-3, 1e-3}, inserts.size(), 2});
    inserter.build(lists, inserts);
    REQUIRE(lists.storage() == storage);
    return lists;
}

TEST_CASE("a list that outgrows its slots makes an append leave Storage::fixed") {
    CELLIST_RANDOM(random, 431u);
    Inserter inserter(Lists<Item>(device(), {1}));
    Inserts<Item> first;
    for (cl_uint i = 0; i < 4000; ++i) first.add(i % 2000, {1.0f, i});
    Inserts<Item> one_long;
    for (cl_uint i = 0; i < 3000; ++i) one_long.add(77, {2.0f, i});
    for (const Overflow overflow : {Overflow::grow, Overflow::drop}) {
        Lists<Item> lists = lists_in(Storage::fixed, inserter, first, overflow);
        const BuildReport report = append(inserter, lists, one_long);
        REQUIRE(lists.storage() != Storage::fixed);
        REQUIRE(report.existing == 4000);
        REQUIRE(report.stored == 7000);
        Oracle<Item> oracle = oracle_of(first, 2000);
        oracle.merge(oracle_of(one_long, 2000));
        require_sound(lists, 7000);
        require_same(lists.download(), oracle);
    }
}

TEST_CASE("a kernel that does not repeat itself makes an append leave Storage::counted") {
    CELLIST_RANDOM(random, 432u);
    Inserter inserter(Lists<Item>(device(), {1}));
    const Inserts<Item> first = random_inserts(100, 2000, random);
    Lists<Item> lists = lists_in(Storage::counted, inserter, first, Overflow::grow);
    std::vector<Inserts<Item>> runs;
    const BuildReport report = lists.append([&] {
        runs.push_back(random_inserts(7 + runs.size(), 2000, random));
        inserter.run(lists, runs.back());
    });
    REQUIRE(report.stored == 100 + runs.back().size());
    Oracle<Item> oracle = oracle_of(first, 2000);
    oracle.merge(oracle_of(runs.back(), 2000));
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
    if (runs.size() > 1) REQUIRE(lists.storage() != Storage::counted);
}

}  // namespace
}  // namespace cellist::test
