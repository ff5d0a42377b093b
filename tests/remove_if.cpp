// SPDX-License-Identifier: MIT
// remove_if() removes exactly the records that its expression selects, and keeps the order.
#include "support/appends.hpp"
#include "support/errors.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Requires that the lists are what is left of other lists.
void require_left(const Lists<Item>& lists, const HostLists<Item>& before, const auto& removes) {
    const HostLists<Item> after = lists.download();
    std::uint64_t left = 0;
    for (std::uint64_t cell = 0; cell < before.cells(); ++cell) {
        std::vector<Item> expected;
        for (const Item& item : before.cell(cell))
            if (!removes(item)) expected.push_back(item);
        left += expected.size();
        const auto list = after.cell(cell);
        REQUIRE(std::vector<Item>(list.begin(), list.end()) == expected);
    }
    require_sound(lists, left);
}

TEST_CASE("the records that an expression selects go, and the others keep their order") {
    const Storage storage =
        GENERATE(Storage::linked, Storage::counted, Storage::fixed, Storage::automatic);
    CELLIST_RANDOM(random, 450u);
    for (const std::size_t count : {0u, 1u, 93u, 4096u}) {
        Lists<Item> lists(device(), {13, 11}, {.storage = storage});
        Inserter inserter(lists);
        inserter.build(lists, random_inserts(count, 150, random));
        if (count != 93) lists.sort(&Item::key);
        HostLists<Item> before = lists.download();
        std::uint64_t removed = lists.remove_if("record.key > limit", {{"limit", 100.0f}});
        const auto is_over = [](const Item& item) { return item.key > 100.0f; };
        REQUIRE(removed == static_cast<std::uint64_t>(std::count_if(
                               before.records().begin(), before.records().end(), is_over)));
        require_left(lists, before, is_over);

        REQUIRE(lists.remove_if("record.key > limit", {{"limit", 100.0f}}) == 0);
        require_left(lists, before, is_over);

        before = lists.download();
        removed = lists.remove_if("record.id % 3");
        const auto is_odd = [](const Item& item) { return item.id % 3 != 0; };
        REQUIRE(removed == static_cast<std::uint64_t>(std::count_if(
                               before.records().begin(), before.records().end(), is_odd)));
        require_left(lists, before, is_odd);

        Oracle<Item> oracle = oracle_in(lists);
        const Inserts<Item> more = random_inserts(93, 143, random);
        REQUIRE(append(inserter, lists, more).existing == oracle.size());
        oracle.merge(oracle_of(more, 143));
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
        lists.sort(&Item::key);
        require_sound(lists, oracle.size());

        REQUIRE(lists.remove_if("1") == oracle.size());
        require_sound(lists, 0);
        REQUIRE(append(inserter, lists, more).stored == 93);
    }
}

TEST_CASE("the room of removed records is free") {
    CELLIST_EACH_STORAGE(storage);
    for (const Overflow overflow : {Overflow::stop, Overflow::drop}) {
        Lists<Item> lists(
            device(), {50},
            {.storage = storage, .overflow = overflow, .capacity_nodes = 1000, .slots = 20});
        Inserter inserter(lists);
        Inserts<Item> full;
        for (cl_uint i = 0; i < 1000; ++i) full.add(i % 50, {1.0f, i});
        require_complete(inserter.build(lists, full), 1000);
        for (int again = 0; again < 3; ++again) {
            REQUIRE(lists.remove_if("record.id < 500") == 500);
            Inserts<Item> half;
            for (cl_uint i = 0; i < 500; ++i) half.add(i % 50, {2.0f, i});
            const BuildReport report = append(inserter, lists, half);
            REQUIRE(report.stored == 1000);
            REQUIRE(report.dropped == 0);
            REQUIRE(lists.capacity_nodes() == 1000);
            require_sound(lists, 1000);
        }
    }
}

TEST_CASE("the room that nearest records leave goes to others") {
    CELLIST_RANDOM(random, 452u);
    Lists<Item> lists(device(), {20}, {.storage = nearest(&Item::key, 5)});
    Inserter inserter(lists);
    inserter.build(lists, random_inserts(4096, 20, random));
    const HostLists<Item> before = lists.download();
    lists.remove_if("record.id & 1");
    require_left(lists, before, [](const Item& item) { return (item.id & 1) != 0; });
    REQUIRE(append(inserter, lists, random_inserts(4096, 20, random)).stored == 100);
    require_sound(lists, 100);
}

TEST_CASE("records leave lists with dropped records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 453u);
    Lists<Item> lists(
        device(), {20},
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 100, .slots = 5});
    Inserter(lists).build(lists, random_inserts(4096, 20, random));
    const HostLists<Item> before = lists.download();
    lists.remove_if("record.id & 1");
    require_left(lists, before, [](const Item& item) { return (item.id & 1) != 0; });
}

TEST_CASE("an expression that is refused leaves the records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 454u);
    Lists<Item> lists(device(), {20}, {.storage = storage});
    Inserter(lists).build(lists, random_inserts(93, 20, random));
    const Oracle<Item> oracle = oracle_in(lists);
    REQUIRE_THROWS_AS(lists.remove_if("record.key = 1"), Error);
    REQUIRE_THROWS_AS(lists.remove_if("record.key > 1) || (true"), Error);
    const auto error = error_of<OpenClError>([&] { lists.remove_if("record.missing"); });
    REQUIRE(contains(error.log(), "remove_if expression"));
    REQUIRE(
        contains(error_of([&] { lists.remove_if(" "); }).what(), "remove_if expression is empty"));
    REQUIRE_THROWS_AS(lists.remove_if("record.key", {{"record", 1}}), Error);
    require_same(lists.download(), oracle);
}

}  // namespace
}  // namespace cellist::test
