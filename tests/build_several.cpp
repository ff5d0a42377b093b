// SPDX-License-Identifier: MIT
// cellist::build fills several containers at once, whatever their storages and policies are, and
// leaves all of them empty where one fails.
#include <stdexcept>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto insert_into_several_source = R"(
#include <cellist/lists.clh>

kernel void into_two(CELLIST_LISTS(Item, a), CELLIST_LISTS(Item, b), uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    Item item = { (float)(i % 17), i };
    cellist_insert(a, i % 31, item);
    if (i % 3 == 0) cellist_insert(b, i % 11, item);
}

kernel void into_three(CELLIST_LISTS(Item, a), CELLIST_LISTS(Item, b), CELLIST_LISTS(Item, c),
                       uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    Item item = { (float)(i % 17), i };
    cellist_insert(a, i % 31, item);
    if (i % 3 == 0) cellist_insert(b, i % 11, item);
    if (i % 2 == 0) cellist_insert(c, 5, item);
}
)";

constexpr cl_uint cells_a = 30;
constexpr cl_uint cells_b = 10;
constexpr cl_uint cells_c = 7;

/// What the kernels insert into the three containers, rejections included.
struct ExpectedLists {
    explicit ExpectedLists(cl_uint count) {
        for (cl_uint i = 0; i < count; ++i) {
            const Item item{static_cast<cl_float>(i % 17), i};
            a.add(i % 31, item);
            if (i % 3 == 0) b.add(i % 11, item);
            if (i % 2 == 0) c.add(5, item);
        }
    }
    Inserts<Item> a, b, c;
};

void require_built(const Lists<Item>& lists, const BuildReport& report,
                   const Inserts<Item>& inserts) {
    const Oracle<Item> oracle = oracle_of(inserts, lists.shape().cells());
    require_complete(report, oracle.size(), inserts.size() - oracle.size());
    REQUIRE(report.capacity_nodes == lists.capacity_nodes());
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
}

void require_empty(const Lists<Item>& lists) {
    require_sound(lists, 0);
    REQUIRE(lists.download().records().empty());
}

/// Options with room for nothing, or for all that the tests insert.
ListsOptions with_room(Storage storage, bool room, Overflow overflow = Overflow::grow) {
    return {.storage = storage,
            .overflow = overflow,
            .capacity_nodes = room ? 2000u : 0u,
            .slots = room ? 600u : 0u};
}

TEST_CASE("two containers of any storages are built at once, growing or not") {
    const Storage first = GENERATE(from_range(all_storages));
    const Storage second = GENERATE(from_range(all_storages));
    for (const bool room_a : {true, false})
        for (const bool room_b : {true, false}) {
            INFO(name_of(first) << (room_a ? "" : ", growing") << " and " << name_of(second)
                                << (room_b ? "" : ", growing"));
            Lists<Item> a(device(), {cells_a}, with_room(first, room_a));
            Lists<Item> b(device(), {cells_b}, with_room(second, room_b));
            Kernel kernel(device(), insert_into_several_source, "into_two", a, b);
            for (const cl_uint count : {1000u, 0u, 93u}) {
                int calls = 0;
                const auto [report_a, report_b] = cellist::build(
                    [&] {
                        ++calls;
                        kernel.run(Range::padded(count, 64), a, b, count);
                    },
                    a, b);
                const ExpectedLists expected(count);
                require_built(a, report_a, expected.a);
                require_built(b, report_b, expected.b);
                REQUIRE(report_a.passes == static_cast<std::uint32_t>(calls));
                REQUIRE(report_b.passes == static_cast<std::uint32_t>(calls));
                REQUIRE(calls <= 2);
            }
        }
}

TEST_CASE("three containers of three storages and policies are built at once") {
    const auto [first, second, third] =
        GENERATE(std::tuple(Storage::linked, Storage::counted, Storage::fixed),
                 std::tuple(Storage::counted, Storage::fixed, Storage::linked),
                 std::tuple(Storage::fixed, Storage::linked, Storage::counted));
    INFO(name_of(first) << ", " << name_of(second) << ", " << name_of(third));
    constexpr cl_uint count = 1000;
    const ExpectedLists expected(count);
    Lists<Item> a(device(), {cells_a}, with_room(first, false));
    Lists<Item> b(device(), {cells_b}, with_room(second, true, Overflow::stop));
    Lists<Item> c(
        device(), {cells_c},
        {.storage = third, .overflow = Overflow::drop, .capacity_nodes = 100, .slots = 100});
    Kernel kernel(device(), insert_into_several_source, "into_three", a, b, c);
    const auto [report_a, report_b, report_c] =
        cellist::build([&] { kernel.run(Range::padded(count, 64), a, b, c, count); }, a, b, c);
    require_built(a, report_a, expected.a);
    require_built(b, report_b, expected.b);
    REQUIRE(report_c.attempted == 500);
    REQUIRE(report_c.stored == 100);
    REQUIRE(report_c.dropped == 400);
    require_sound(c, 100);
    for (const Item& item : c.download().cell(5)) REQUIRE(item.id % 2 == 0);

    // b stops: it has no room any more.
    Lists<Item> small(device(), {cells_b}, with_room(second, false, Overflow::stop));
    const auto error = error_of<OverflowError>([&] {
        cellist::build([&] { kernel.run(Range::padded(count, 64), a, small, c, count); }, a, small,
                       c);
    });
    INFO(error.what());
    const std::uint64_t demand = oracle_of(expected.b, cells_b).size();
    REQUIRE(error.report().stored == 0);
    REQUIRE(error.report().dropped == demand);
    REQUIRE(error.report().rejected == expected.b.size() - demand);
    require_empty(a);
    require_empty(small);
    require_empty(c);

    const auto again =
        cellist::build([&] { kernel.run(Range::padded(count, 64), a, b, c, count); }, a, b, c);
    require_built(a, again[0], expected.a);
    require_built(b, again[1], expected.b);
    require_sound(c, 100);
}

TEST_CASE("all containers are empty after one of two has thrown") {
    const Storage first = GENERATE(from_range(all_storages));
    const Storage second = GENERATE(from_range(all_storages));
    constexpr cl_uint count = 500;
    const ExpectedLists expected(count);
    for (const bool room_a : {true, false}) {
        INFO(name_of(first) << (room_a ? "" : ", growing") << " and " << name_of(second)
                            << ", which stops");
        Lists<Item> a(device(), {cells_a}, with_room(first, room_a));
        Lists<Item> b(device(), {cells_b}, with_room(second, false, Overflow::stop));
        Kernel kernel(device(), insert_into_several_source, "into_two", a, b);
        const auto insert = [&] { kernel.run(Range::padded(count, 64), a, b, count); };
        (void)error_of<OverflowError>([&] { cellist::build(insert, a, b); });
        require_empty(a);
        require_empty(b);
        (void)error_of<OverflowError>([&] { cellist::build(insert, b, a); });
        require_empty(a);
        require_empty(b);

        Lists<Item> roomy(device(), {cells_b}, with_room(second, false));
        const auto [report_a, report_b] = cellist::build(
            [&] { kernel.run(Range::padded(count, 64), a, roomy, count); }, a, roomy);
        require_built(a, report_a, expected.a);
        require_built(roomy, report_b, expected.b);
    }
}

TEST_CASE("all containers are empty after the inserting code has thrown, in any pass") {
    const Storage first = GENERATE(from_range(all_storages));
    const Storage second = GENERATE(from_range(all_storages));
    INFO(name_of(first) << " and " << name_of(second));
    constexpr cl_uint count = 500;
    for (const int failing : {1, 2}) {
        Lists<Item> a(device(), {cells_a}, with_room(first, false));
        Lists<Item> b(device(), {cells_b}, with_room(second, false));
        Kernel kernel(device(), insert_into_several_source, "into_two", a, b);
        int calls = 0;
        REQUIRE_THROWS_AS(cellist::build(
                              [&] {
                                  kernel.run(Range::padded(count, 64), a, b, count);
                                  if (++calls == failing) throw std::runtime_error("the caller's");
                              },
                              a, b),
                          std::runtime_error);
        REQUIRE(calls == failing);
        require_empty(a);
        require_empty(b);
        const auto [report_a, report_b] =
            cellist::build([&] { kernel.run(Range::padded(count, 64), a, b, count); }, a, b);
        require_built(a, report_a, ExpectedLists(count).a);
        require_built(b, report_b, ExpectedLists(count).b);
    }
}

TEST_CASE("a kernel that does not repeat itself empties the containers beside counted ones, too") {
    Lists<Item> a(device(), {cells_a}, with_room(Storage::linked, true));
    Lists<Item> b(device(), {cells_b}, with_room(Storage::counted, true));
    Kernel kernel(device(), insert_into_several_source, "into_two", a, b);
    cl_uint count = 500;
    const auto error =
        error_of([&] { cellist::build([&] { kernel.run(512, a, b, count -= 3); }, a, b); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "same records every time"));
    require_empty(a);
    require_empty(b);
}

}  // namespace
}  // namespace cellist::test
