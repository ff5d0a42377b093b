// SPDX-License-Identifier: MIT
// Lists of any length are sorted by a key, then by their other members.
#include <bit>
#include <limits>
#include <tuple>

#include "support/errors.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("lists of every length are sorted") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 70u);
    const std::vector<cl_uint> lengths{0, 1, 2, 3, 4, 5, 7, 8, 31, 32, 33, 1000, 0, 1023, 1024};
    Inserts<Item> inserts;
    for (cl_uint cell = 0; cell < lengths.size(); ++cell)
        for (cl_uint i = 0; i < lengths[cell]; ++i)
            inserts.add(cell, {static_cast<cl_float>(below(random, 500)) - 250.0f,
                               static_cast<cl_uint>(inserts.size())});
    inserts.shuffle(random);
    Lists<Item> lists(device(), {lengths.size()}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    const Oracle<Item> oracle = oracle_of(inserts, lengths.size());

    lists.sort(&Item::key);
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle, by_key);
    SECTION("twice") {
        lists.sort(&Item::key);
        require_sorted(lists.download(), oracle, by_key);
    }
    SECTION("by another member afterwards") {
        lists.sort(&Item::id);
        require_sound(lists, inserts.size());
        require_sorted(lists.download(), oracle, by_id);
    }
}

TEST_CASE("lists that are sorted already, upwards or downwards, are sorted") {
    CELLIST_EACH_STORAGE(storage);
    for (const bool upwards : {true, false}) {
        Inserts<Item> inserts;
        for (cl_uint i = 0; i < 3000; ++i)
            inserts.add(0, {static_cast<cl_float>(upwards ? i : 3000 - i), i});
        Lists<Item> lists(device(), {1}, {.storage = storage});
        Inserter(lists).build(lists, inserts);
        lists.sort(&Item::key);
        require_sorted(lists.download(), oracle_of(inserts, 1), by_key);
    }
}

struct Nested {
    Item item;
    cl_short2 pair;
    cl_uchar bytes[2][2];
};
CELLIST_STRUCT(Nested, item, pair, bytes);

TEST_CASE("ties are ordered by the scalars of vectors, arrays and nested structs") {
    CELLIST_RANDOM(random, 81u);
    Inserts<Nested> inserts;
    for (int i = 0; i < 3000; ++i) {
        Nested nested{};
        nested.item = {static_cast<cl_float>(below(random, 2)), below(random, 2)};
        nested.pair = {{static_cast<cl_short>(below(random, 3) - 1),
                        static_cast<cl_short>(below(random, 3) - 1)}};
        for (auto& row : nested.bytes)
            for (cl_uchar& byte : row) byte = static_cast<cl_uchar>(below(random, 3) * 100);
        inserts.add(below(random, 3), nested);
    }
    Lists<Nested> lists(device(), {3});
    Inserter(lists).build(lists, inserts);
    lists.sort_by("record.bytes[1][0]");
    const auto values = [](const Nested& nested) {
        return std::tuple(nested.bytes[1][0], nested.item.key, nested.item.id, nested.pair.s[0],
                          nested.pair.s[1], nested.bytes[0][0], nested.bytes[0][1],
                          nested.bytes[1][0], nested.bytes[1][1]);
    };
    const HostLists<Nested> found = lists.download();
    require_same(found, oracle_of(inserts, 3));
    for (std::uint64_t cell = 0; cell < 3; ++cell) {
        const auto list = found.cell(cell);
        REQUIRE(std::is_sorted(list.begin(), list.end(), [&](const Nested& a, const Nested& b) {
            return values(a) < values(b);
        }));
    }
}

TEST_CASE("lists are sorted by an expression of the record") {
    CELLIST_RANDOM(random, 72u);
    const Inserts<Item> inserts = random_inserts(4096, 10, random);
    Lists<Item> lists(device(), {10});
    Inserter(lists).build(lists, inserts);
    const Oracle<Item> oracle = oracle_of(inserts, 10);

    lists.sort_by("record.key * record.key");
    require_sorted(lists.download(), oracle, [](const Item& a, const Item& b) {
        return std::tuple(a.key * a.key, a.key, a.id) < std::tuple(b.key * b.key, b.key, b.id);
    });
    lists.sort_by("-(long)record.id");
    require_sorted(lists.download(), oracle,
                   [](const Item& a, const Item& b) { return a.id > b.id; });
    lists.sort_by("(uchar)(record.id % 7)");
    require_sorted(lists.download(), oracle, [](const Item& a, const Item& b) {
        return std::tuple(a.id % 7, a.key, a.id) < std::tuple(b.id % 7, b.key, b.id);
    });
    lists.sort_by("record.key < 0 ? 1 : -1");
    require_sorted(lists.download(), oracle, [](const Item& a, const Item& b) {
        return std::tuple(a.key < 0, a.key, a.id) < std::tuple(b.key < 0, b.key, b.id);
    });
    require_sound(lists, 4096);
}

TEST_CASE("an expression that does not compile ends in an error with the compiler's log") {
    CELLIST_RANDOM(random, 73u);
    Lists<Item> lists(device(), {10});
    const Inserts<Item> inserts = random_inserts(144, 10, random);
    Inserter(lists).build(lists, inserts);
    for (const char* expression : {"record.no_such_member", "record.key + + / 3", "1 +"}) {
        const auto error = error_of<OpenClError>([&] { lists.sort_by(expression); });
        INFO(error.what());
        REQUIRE(error.call() == "clBuildProgram");
        REQUIRE_FALSE(error.log().empty());
        REQUIRE(contains(error.what(), error.log()));
    }
    const auto error = error_of<OpenClError>([&] { lists.sort_by("record.no_such_member"); });
    REQUIRE(contains(error.log(), "no_such_member"));
    REQUIRE(contains(error_of([&] { lists.sort_by(" "); }).what(), "sort expression is empty"));
    require_sound(lists, 144);
    lists.sort(&Item::key);
    require_sorted(lists.download(), oracle_of(inserts, 10), by_key);
}

TEST_CASE("sorted lists are built anew") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 74u);
    Lists<Item> lists(device(), {10}, {.storage = storage, .capacity_nodes = 100});
    Inserter inserter(lists);
    for (const std::size_t count : {93u, 4096u, 7u}) {
        const Inserts<Item> inserts = random_inserts(count, 10, random);
        require_complete(inserter.build(lists, inserts), count);
        require_same(lists.download(), oracle_of(inserts, 10));
        lists.sort(&Item::key);
        require_sorted(lists.download(), oracle_of(inserts, 10), by_key);
    }
}

TEST_CASE("empty containers are sorted") {
    CELLIST_EACH_STORAGE(storage);
    for (const Shape& shape : {Shape{0}, Shape{1}, Shape{100, 3}}) {
        Lists<Item> lists(device(), shape, {.storage = storage});
        lists.sort(&Item::key);
        require_sound(lists, 0);
    }
}

}  // namespace
}  // namespace cellist::test
