// What a container starts with where its options say nothing, for each storage.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("linked is the default, and starts with a node for each cell, at least 65,536") {
    REQUIRE(ListsOptions{}.storage == Storage::linked);
    REQUIRE(ListsOptions{}.overflow == Overflow::grow);
    REQUIRE(Lists<Item>(device(), {10}).capacity_nodes() == 65'536);
    REQUIRE(Lists<Item>(device(), {100'000}).capacity_nodes() == 100'000);
}

TEST_CASE("counted starts without nodes") {
    REQUIRE(Lists<Item>(device(), {10}, {.storage = Storage::counted}).capacity_nodes() == 0);
}

TEST_CASE("fixed starts with four slots for each cell, and has no use for capacity_nodes") {
    REQUIRE(Lists<Item>(device(), {10}, {.storage = Storage::fixed}).capacity_nodes() == 40);
    REQUIRE(Lists<Item>(device(), {10}, {.storage = Storage::fixed, .capacity_nodes = 1000})
                .capacity_nodes() == 40);
    REQUIRE(Lists<Item>(device(), {0}, {.storage = Storage::fixed}).capacity_nodes() == 0);
}

TEST_CASE("only fixed has a use for slots") {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    INFO("storage " << name_of(storage));
    CELLIST_RANDOM(random, 250u);
    Lists<Item> lists(device(), {10}, {.storage = storage, .slots = 1});
    require_complete(Inserter(lists).build(lists, random_inserts(144, 10, random)), 144);
}

TEST_CASE("the memory of a container is its heads, its nodes and its counters") {
    CELLIST_EACH_STORAGE(storage);
    const auto bytes = [&](std::uint64_t cells, std::uint32_t room) {
        return Lists<Item>(device(), {cells},
                           {.storage = storage, .capacity_nodes = room, .slots = room})
            .pool_bytes();
    };
    const std::uint64_t counters = bytes(0, 0) - (storage == Storage::counted ? 4 : 0);
    REQUIRE(counters <= 257 * 64);
    switch (storage) {
        case Storage::linked:
            REQUIRE(bytes(100, 7) == counters + 100 * 4 + 7 * 12);
            break;
        case Storage::counted:
            REQUIRE(bytes(100, 7) == counters + 201 * 4 + 7 * 8);
            break;
        case Storage::fixed:
            REQUIRE(bytes(100, 7) == counters + 100 * 4 + 100 * 7 * 8);
            break;
        case Storage::automatic:
            break;
    }
}

TEST_CASE("stop and drop need to know the room, in every storage") {
    CELLIST_EACH_STORAGE(storage);
    for (const Overflow overflow : {Overflow::stop, Overflow::drop}) {
        const auto error = error_of(
            [&] { Lists<Item>(device(), {5}, {.storage = storage, .overflow = overflow}); });
        INFO(error.what());
        REQUIRE(contains(error.what(), storage == Storage::fixed ? "slots" : "capacity_nodes"));
    }
}

TEST_CASE("a storage that does not exist is refused") {
    REQUIRE_THROWS_AS(Lists<Item>(device(), {5}, {.storage = static_cast<Storage>(7)}), Error);
}

TEST_CASE("heads over the budget are refused in every storage") {
    CELLIST_EACH_STORAGE(storage);
    const auto error = error_of([&] {
        Lists<Item>(device(), {1000}, {.storage = storage, .slots = 0, .budget_bytes = 3999});
    });
    INFO(error.what());
    REQUIRE(contains(error.what(), "3999"));
    REQUIRE(contains(error.what(), "1000"));
}

}  // namespace
}  // namespace cellist::test
