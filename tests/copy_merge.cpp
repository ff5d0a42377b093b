// SPDX-License-Identifier: MIT
// copy() and merge() hold exactly the records of their lists.
#include "support/appends.hpp"
#include "support/errors.hpp"
#include "support/internals.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("a copy has the same lists in the same order, and a life of its own") {
    const Storage storage =
        GENERATE(Storage::linked, Storage::counted, Storage::fixed, Storage::automatic);
    CELLIST_RANDOM(random, 440u);
    for (const std::size_t count : {0u, 1u, 93u, 4096u}) {
        Lists<Item> lists(device(), {40, 3}, {.storage = storage});
        Inserter inserter(lists);
        const Inserts<Item> inserts = random_inserts(count, 130, random);
        inserter.build(lists, inserts);
        lists.sort(&Item::key);
        const HostLists<Item> sorted = lists.download();
        Lists<Item> copy = lists.copy();
        REQUIRE(copy.shape() == lists.shape());
        REQUIRE(copy.storage() == lists.storage());
        lists.clear();
        require_sound(copy, sorted.records().size());
        REQUIRE(copy.download().offsets() == sorted.offsets());
        REQUIRE(copy.download().records() == sorted.records());
        require_sound(lists, 0);

        const Inserts<Item> more = random_inserts(144, 120, random);
        REQUIRE(append(inserter, copy, more).existing == sorted.records().size());
        Oracle<Item> oracle = oracle_of(inserts, 120);
        oracle.merge(oracle_of(more, 120));
        require_sound(copy, oracle.size());
        require_same(copy.download(), oracle);
    }
}

TEST_CASE("a copy keeps the policy and the nearest records") {
    CELLIST_RANDOM(random, 441u);
    Lists<Item> lists(device(), {20}, {.storage = nearest(&Item::key, 5)});
    Inserter inserter(lists);
    inserter.build(lists, random_inserts(4096, 20, random));
    Lists<Item> copy = lists.copy();
    require_sound(copy, 100);
    require_same(copy.download(), oracle_in(lists));
    const Inserts<Item> more = random_inserts(4096, 20, random);
    append(inserter, lists, more);
    append(inserter, copy, more);
    require_same(copy.download(), oracle_in(lists));

    Lists<Item> full(device(), {20}, {.overflow = Overflow::stop, .capacity_nodes = 100});
    inserter.build(full, random_inserts(100, 20, random));
    Lists<Item> of_full = full.copy();
    REQUIRE(of_full.capacity_nodes() == 100);
    REQUIRE_THROWS_AS(append(inserter, of_full, random_inserts(1, 20, random)), OverflowError);
    require_sound(of_full, 100);
}

TEST_CASE("lists with dropped records can be copied") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 442u);
    Lists<Item> lists(
        device(), {20},
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 100, .slots = 5});
    Inserter(lists).build(lists, random_inserts(4096, 20, random));
    const Lists<Item> copy = lists.copy();
    require_sound(copy, 100);
    require_same(copy.download(), oracle_in(lists));
}

TEST_CASE("merged lists hold the records of both, in any two storages") {
    const Storage into = GENERATE(from_range(all_storages));
    const Storage from = GENERATE(from_range(all_storages));
    CELLIST_RANDOM(random, 443u);
    INFO(name_of(from) << " into " << name_of(into));
    for (const std::uint64_t capacity : {93u, 5000u}) {
        Lists<Item> a(device(), {50}, {.storage = into, .capacity_nodes = capacity, .slots = 6});
        Lists<Item> b(device(), {50}, {.storage = from});
        Inserter inserter(a);
        const Inserts<Item> first = random_inserts(93, 50, random);
        const Inserts<Item> second = random_inserts(300, 50, random);
        inserter.build(a, first);
        inserter.build(b, second);
        const BuildReport report = a.merge(b);
        REQUIRE(report.existing == 93);
        REQUIRE(report.attempted == 300);
        REQUIRE(report.stored == 393);
        Oracle<Item> oracle = oracle_of(first, 50);
        oracle.merge(oracle_of(second, 50));
        require_sound(a, 393);
        require_same(a.download(), oracle);
        require_sound(b, 300);
        require_same(b.download(), oracle_of(second, 50));
    }
}

TEST_CASE("a merge that is stopped leaves both lists as they were") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 444u);
    Lists<Item> a(
        device(), {50},
        {.storage = storage, .overflow = Overflow::stop, .capacity_nodes = 100, .slots = 2});
    Lists<Item> b(device(), {50});
    Inserter inserter(a);
    Inserts<Item> first;
    for (cl_uint i = 0; i < 93; ++i) first.add(i % 50, {1.0f, i});
    const Inserts<Item> second = random_inserts(93, 50, random);
    inserter.build(a, first);
    inserter.build(b, second);
    REQUIRE_THROWS_AS(a.merge(b), OverflowError);
    require_sound(a, 93);
    require_same(a.download(), oracle_of(first, 50));
    require_same(b.download(), oracle_of(second, 50));
}

TEST_CASE("lists of other shapes, and the lists themselves, are not merged") {
    Lists<Item> lists(device(), {50});
    const auto shapes = error_of([&] { lists.merge(Lists<Item>(device(), {5, 10})); });
    REQUIRE(contains(shapes.what(), "5x10"));
    REQUIRE_THROWS_AS(lists.merge(lists), Error);
}

}  // namespace
}  // namespace cellist::test
