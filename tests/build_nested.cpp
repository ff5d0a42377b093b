// SPDX-License-Identifier: MIT
// A container cannot be built inside of its own build, in any way. The build around it goes on.
#include <functional>
#include <optional>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto insert_one_source = R"(
#include <cellist/lists.clh>
kernel void insert(CELLIST_LISTS(Item, lists))
{
    const uint i = get_global_id(0);
    Item item = { (float)i, i };
    cellist_insert(lists, i % cellist_cells(lists), item);
}
)";

TEST_CASE("every way to build a container inside of its own build is refused") {
    const Storage storage = GENERATE(from_range(all_storages), value(Storage::automatic));
    INFO(name_of(storage));
    Lists<Item> lists(device(), {17}, {.storage = storage});
    Lists<Item> other(device(), {17});
    Kernel insert(device(), insert_one_source, "insert", lists, other);
    const auto run = [&] { insert.run(1000, lists); };
    const std::vector<std::function<void()>> ways{
        [&] { lists.build(insert, 500); },
        [&] { lists.build(run); },
        [&] { (void)lists.build_async(insert, 500); },
        [&] { (void)lists.build_async(run); },
        [&] { lists.build_slices(run, [](const Slice&) {}); },
        [&] { cellist::build(run, lists); },
        [&] { cellist::build(run, other, lists); },
        [&] { (void)cellist::build_async(run, other, lists); },
        [&] { lists.clear(); },
        [&] { lists.sort(&Item::key); },
    };
    int refused = 0;
    const auto insert_and_try = [&] {
        run();
        for (const auto& way : ways) {
            const Error error = error_of(way);
            INFO(error.what());
            REQUIRE(contains(error.what(), "while it is built"));
            ++refused;
        }
        run();
    };
    require_complete(lists.build(insert_and_try), 2000);
    require_sound(lists, 2000);
    require_complete(lists.build_async(insert_and_try).get(), 2000);
    const BuildReport report = lists.build_slices(insert_and_try, [&](const Slice&) {
        for (const auto& way : {ways[0], ways[4], ways[5]})
            REQUIRE(contains(error_of(way).what(), "while a slice of it is read"));
    });
    REQUIRE(report.stored == 2000);
    REQUIRE(refused > 0);
    require_complete(lists.build(insert, 500), 500);
    require_sound(lists, 500);
}

TEST_CASE("a refusal that is not caught ends the build around it") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(device(), {17}, {.storage = storage});
    Kernel insert(device(), insert_one_source, "insert", lists);
    REQUIRE_THROWS_AS(lists.build([&] {
        insert.run(10, lists);
        lists.build_slices([&] { insert.run(10, lists); }, [](const Slice&) {});
    }),
                      Error);
    require_sound(lists, 0);
    require_complete(lists.build(insert, 500), 500);
}

TEST_CASE("a container that is replaced in the midst of its build ends it with an error") {
    const Storage storage = GENERATE(from_range(all_storages), value(Storage::automatic));
    INFO(name_of(storage));
    const auto made = [&](std::uint64_t capacity) {
        return Lists<Item>(device(), {17},
                           {.storage = storage, .capacity_nodes = capacity, .slots = 1});
    };
    for (const std::uint64_t capacity : {0u, 5000u}) {
        Lists<Item> lists = made(capacity);
        Kernel insert(device(), insert_one_source, "insert", lists);
        const auto replace = [&] {
            insert.run(1000, lists);
            lists = made(capacity);
        };
        REQUIRE_THROWS_AS(lists.build(replace), Error);
        REQUIRE_THROWS_AS(cellist::build(replace, lists), Error);
        REQUIRE_THROWS_AS(lists.build_slices(replace, [](const Slice&) {}), Error);
        REQUIRE_THROWS_AS(cellist::build_async(replace, lists).get(), Error);
        require_complete(lists.build(insert, 500), 500);

        std::optional<Lists<Item>> gone(made(capacity));
        REQUIRE_THROWS_AS(gone->build([&] {
            insert.run(1000, *gone);
            gone.reset();
        }),
                          Error);
    }
}

}  // namespace
}  // namespace cellist::test
