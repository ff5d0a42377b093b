// SPDX-License-Identifier: MIT
// Everything that is inserted is found again, in its cell.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

void insert_and_compare(Storage storage, const Shape& shape, const Inserts<Item>& inserts) {
    INFO("shape " << shape.to_string() << ", " << inserts.size() << " inserts");
    Lists<Item> lists(device(), shape, {.storage = storage});
    const BuildReport report = Inserter(lists).build(lists, inserts);
    const Oracle<Item> oracle = oracle_of(inserts, shape.cells());
    require_complete(report, oracle.size(), inserts.size() - oracle.size());
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
}

TEST_CASE("every record is found in its cell, for every number of records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 1u);
    for (const std::size_t count : {0u, 1u, 7u, 93u, 144u, 4096u}) {
        insert_and_compare(storage, {16, 9}, random_inserts(count, 16 * 9, random));
        insert_and_compare(storage, {1}, random_inserts(count, 1, random));
    }
}

TEST_CASE("a million records are found in their cells") {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    INFO("storage " << name_of(storage));
    CELLIST_RANDOM(random, 2u);
    insert_and_compare(storage, {1024, 64}, random_inserts(1'000'000, 1024 * 64, random));
}

TEST_CASE("shapes have one to four dimensions") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 3u);
    for (const Shape& shape : {Shape{210}, Shape{30, 7}, Shape{5, 6, 7}, Shape{2, 3, 5, 7}})
        insert_and_compare(storage, shape, random_inserts(1000, 210, random));
}

TEST_CASE("all records in one cell make one list") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 4u);
    for (const std::size_t count : {93u, 4096u, 100'000u}) {
        Inserts<Item> inserts = random_inserts(count, 1, random);
        for (cl_uint& cell : inserts.cells) cell = 77;
        insert_and_compare(storage, {100}, inserts);
    }
}

TEST_CASE("without a cell every record is rejected") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 5u);
    for (const Shape& shape : {Shape{0}, Shape{0, 5}, Shape{7, 0, 3}})
        insert_and_compare(storage, shape, random_inserts(144, 10, random));
}

TEST_CASE("records for cells outside of the shape are rejected and counted") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 6u);
    Inserts<Item> inserts = random_inserts(4096, 150, random);
    inserts.add(0xFFFFFFFFu, {1.0f, 4096});
    inserts.add(0x80000000u, {1.0f, 4097});
    inserts.add(144, {1.0f, 4098});
    insert_and_compare(storage, {16, 9}, inserts);
}

TEST_CASE("a build replaces what the lists held before") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 7u);
    Lists<Item> lists(device(), {50}, {.storage = storage});
    Inserter inserter(lists);
    inserter.build(lists, random_inserts(4096, 50, random));
    const Inserts<Item> second = random_inserts(93, 50, random);
    require_complete(inserter.build(lists, second), 93);
    require_sound(lists, 93);
    require_same(lists.download(), oracle_of(second, 50));
}

TEST_CASE("cleared lists are empty and keep their capacity") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 8u);
    Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 10});
    Inserter inserter(lists);
    inserter.build(lists, random_inserts(144, 50, random));
    const std::uint64_t capacity = lists.capacity_nodes();
    if (!has_slots(storage)) REQUIRE(capacity == 144);
    lists.clear();
    REQUIRE(lists.capacity_nodes() == capacity);
    require_sound(lists, 0);
    REQUIRE(lists.download().records().empty());
}

TEST_CASE("inserts outside of a build are refused, and validate() counts them") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 9u);
    Lists<Item> lists(device(), {50}, {.storage = storage});
    Inserter inserter(lists);
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    inserter.build(lists, inserts);
    inserter.run(lists, random_inserts(93, 50, random));
    Inserts<Item> outside;
    outside.add(50, {});
    inserter.run(lists, outside);

    require_same(lists.download(), oracle_of(inserts, 50));
    const Validation validation = lists.validate();
    REQUIRE_FALSE(validation.ok());
    REQUIRE(validation.late_inserts == 93);
    REQUIRE(validation.broken_links + validation.repeated_nodes + validation.lost_nodes == 0);
    REQUIRE(validation.message() == "93 inserts outside of a build were refused");

    require_complete(inserter.build(lists, inserts), 144);
    require_sound(lists, 144);
}

}  // namespace
}  // namespace cellist::test
