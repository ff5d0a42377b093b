// SPDX-License-Identifier: MIT
// Inserts from kernels of any form: loops, divergent branches, ranges of 2 and 3 dimensions,
// several containers.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

struct Spark {
    cl_uint id;
    cl_ushort heat;
    cl_uchar rgb[3];
};
CELLIST_STRUCT(Spark, id, heat, rgb);

constexpr auto inserting_kernels_source = R"(
#include <cellist/lists.clh>

kernel void loops(CELLIST_LISTS(Item, lists), uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    for (uint k = 0; k < i % 13; ++k) {
        if ((i + k) % 3 == 0) continue;
        Item item = { (float)k, i };
        if (k % 2) cellist_insert(lists, (i * 7 + k) % 101, item);
        else cellist_insert(lists, i % 101, item);
        if (k > 9) break;
    }
}

static void put(CELLIST_LISTS(Item, lists), uint cell, float key)
{
    Item item = { key, cell };
    cellist_insert(lists, cell, item);
}

kernel void plane(CELLIST_LISTS(Item, lists))
{
    const int x = get_global_id(0), y = get_global_id(1);
    put(CELLIST_PASS(lists), cellist_cell2(lists, x, y), (float)(x * 1000 + y));
}

kernel void space(CELLIST_LISTS(Item, lists))
{
    const uint x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
    put(CELLIST_PASS(lists), cellist_cell3(lists, x, y, z), (float)(x * 10000 + y * 100 + z));
}

kernel void taken(CELLIST_LISTS(Item, lists), global uint* taken)
{
    const uint i = get_global_id(0);
    Item item = { 0.0f, i };
    taken[i] = cellist_insert(lists, i, item);
}
)";

constexpr auto two_containers = R"(
#include <cellist/lists.clh>

kernel void both(uint first, CELLIST_LISTS(Item, items), global const uint* heat,
                 CELLIST_LISTS(Spark, sparks), uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    Item item = { (float)i, first + i };
    cellist_insert(items, i % 10, item);
    if (i % 2) return;
    Spark spark = { i, (ushort)heat[i], { 1, 2, (uchar)i } };
    cellist_insert(sparks, cellist_cell2(sparks, i % 4, i % 5), spark);
}

kernel void more(CELLIST_LISTS(Spark, sparks))
{
    Spark spark = { 1000 + get_global_id(0), 0, { 0, 0, 0 } };
    cellist_insert(sparks, 0u, spark);
}

// Reads one container and inserts into another of the same type.
kernel void copy(CELLIST_LISTS(Item, from), CELLIST_LISTS(Item, to))
{
    const uint cell = get_global_id(0);
    cellist_for_each(from, cell, node) cellist_insert(to, cell, cellist_get(from, node));
}

// The number of records of each cell, and the sum of their ids.
kernel void sums(CELLIST_LISTS(Item, lists), global uint2* sums)
{
    const uint cell = get_global_id(0);
    uint2 sum = (uint2)(0u, 0u);
    cellist_for_each(lists, cell, node) sum += (uint2)(1u, cellist_get(lists, node).id);
    sums[cell] = sum;
}
)";

TEST_CASE("a work-item inserts any number of records, in divergent loops") {
    CELLIST_EACH_STORAGE(storage);
    constexpr cl_uint count = 3000;
    Lists<Item> lists(device(), {101}, {.storage = storage, .capacity_nodes = 5});
    Kernel kernel(device(), inserting_kernels_source, "loops", lists);
    Oracle<Item> oracle;
    for (cl_uint i = 0; i < count; ++i)
        for (cl_uint k = 0; k < i % 13; ++k) {
            if ((i + k) % 3 == 0) continue;
            oracle.emplace(k % 2 != 0 ? (i * 7 + k) % 101 : i % 101,
                           Item{static_cast<cl_float>(k), i});
            if (k > 9) break;
        }
    require_complete(lists.build(kernel, Range::padded(count), count), oracle.size());
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
}

TEST_CASE("kernels insert from ranges of two dimensions") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(device(), {37, 21}, {.storage = storage});
    Kernel kernel(device(), inserting_kernels_source, "plane", lists);
    require_complete(lists.build(kernel, {40, 24}), 37 * 21, 40 * 24 - 37 * 21);
    const HostLists<Item> host = lists.download();
    for (cl_uint y = 0; y < 21; ++y)
        for (cl_uint x = 0; x < 37; ++x) {
            const auto list = host[{x, y}];
            REQUIRE(list.size() == 1);
            REQUIRE(list[0] == Item{static_cast<cl_float>(x * 1000 + y), y * 37 + x});
        }
}

TEST_CASE("kernels insert from ranges of three dimensions") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(device(), {11, 7, 5}, {.storage = storage});
    Kernel kernel(device(), inserting_kernels_source, "space", lists);
    require_complete(lists.build(kernel, {12, 8, 6}), 11 * 7 * 5, 12 * 8 * 6 - 11 * 7 * 5);
    const HostLists<Item> host = lists.download();
    for (cl_uint z = 0; z < 5; ++z)
        for (cl_uint y = 0; y < 7; ++y)
            for (cl_uint x = 0; x < 11; ++x) {
                const auto list = host[{x, y, z}];
                REQUIRE(list.size() == 1);
                REQUIRE(list[0] ==
                        Item{static_cast<cl_float>(x * 10000 + y * 100 + z), (z * 7 + y) * 11 + x});
            }
}

TEST_CASE("an insert says whether the record was taken") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(
        device(), {1000},
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 700, .slots = 1});
    Kernel kernel(device(), inserting_kernels_source, "taken", lists);
    const Buffer<cl_uint> device_taken(device(), 1200);
    const BuildReport report = lists.build(kernel, 1200, device_taken);
    const std::vector<cl_uint> taken = device_taken.download();
    const HostLists<Item> host = lists.download();
    for (std::size_t i = 0; i < taken.size(); ++i)
        REQUIRE(taken[i] == (i < 1000 && !host.cell(i).empty() ? 1u : 0u));
    REQUIRE(report.stored == (has_slots(storage) ? 1000 : 700));
}

TEST_CASE("one kernel inserts into containers of different types") {
    constexpr cl_uint count = 1001;
    Lists<Item> items(device(), {10}, {.capacity_nodes = 3});
    Lists<Spark> sparks(device(), {4, 5}, {.capacity_nodes = 2000});
    Kernel both(device(), two_containers, "both", items, sparks);
    Kernel more(device(), two_containers, "more", items, sparks);
    std::vector<cl_uint> host_heat(count);
    for (cl_uint i = 0; i < count; ++i) host_heat[i] = i * 31 % 65536;
    const Buffer<cl_uint> heat(device(), host_heat);

    const auto insert = [&] {
        both.run(Range::padded(count), cl_uint{5}, items, heat, sparks, count);
    };
    // A container that the build does not name would lose its records.
    REQUIRE_THROWS_AS(sparks.build(insert), Error);
    require_complete(sparks.build([&] { more.run(50, sparks); }), 50);
    require_sound(sparks, 50);
    const auto [items_report, sparks_report] = build(insert, items, sparks);
    require_complete(items_report, count);
    require_complete(sparks_report, 501);

    const HostLists<Item> host_items = items.download();
    std::vector<Item> all = host_items.records();
    REQUIRE(all.size() == count);
    for (std::uint64_t cell = 0; cell < 10; ++cell)
        for (const Item& item : host_items.cell(cell)) {
            REQUIRE(item.id - 5 == static_cast<cl_uint>(item.key));
            REQUIRE(static_cast<cl_uint>(item.key) % 10 == cell);
        }
    const HostLists<Spark> host_sparks = sparks.download();
    REQUIRE(host_sparks.records().size() == 501);
    for (cl_uint y = 0; y < 5; ++y)
        for (cl_uint x = 0; x < 4; ++x)
            for (const Spark& spark : host_sparks[{x, y}]) {
                REQUIRE(spark.id % 4 == x);
                REQUIRE(spark.id % 5 == y);
                REQUIRE(spark.heat == spark.id * 31 % 65536);
                REQUIRE(spark.rgb[1] == 2);
                REQUIRE(spark.rgb[2] == spark.id % 256);
            }
}

TEST_CASE("kernels of a build read what earlier kernels have inserted") {
    const Storage storage = GENERATE(Storage::linked, Storage::fixed);
    INFO(name_of(storage));
    CELLIST_RANDOM(random, 14u);
    Lists<Item> lists(device(), {40}, {.storage = storage, .capacity_nodes = 100});
    const Lists<Spark> sparks(device(), {1});
    Kernel kernel(device(), two_containers, "sums", lists, sparks);
    Buffer<cl_uint2> sums(device(), 40);
    const Inserts<Item> inserts = random_inserts(4096, 40, random);
    Inserter inserter(lists);
    require_complete(lists.build([&] {
        inserter.run(lists, inserts);
        kernel.run(40, lists, sums);
    }),
                     4096);
    std::vector<cl_uint2> expected(40);
    for (const auto& [cell, item] : oracle_of(inserts, 40)) {
        ++expected[cell].s[0];
        expected[cell].s[1] += item.id;
    }
    const std::vector<cl_uint2> found = sums.download();
    for (std::size_t cell = 0; cell < 40; ++cell) {
        CHECK(found[cell].s[0] == expected[cell].s[0]);
        CHECK(found[cell].s[1] == expected[cell].s[1]);
    }
    require_same(lists.download(), oracle_of(inserts, 40));
}

TEST_CASE("a kernel reads one container and inserts into another of the same type") {
    CELLIST_RANDOM(random, 10u);
    const auto [storage_from, storage_to] = GENERATE(
        std::pair(Storage::linked, Storage::linked), std::pair(Storage::linked, Storage::counted),
        std::pair(Storage::counted, Storage::fixed), std::pair(Storage::fixed, Storage::linked));
    INFO(name_of(storage_from) << " to " << name_of(storage_to));
    Lists<Item> from(device(), {40}, {.storage = storage_from});
    Lists<Item> to(device(), {40}, {.storage = storage_to, .capacity_nodes = 1});
    const Lists<Spark> sparks(device(), {1});
    const Inserts<Item> inserts = random_inserts(4096, 40, random);
    Inserter(from).build(from, inserts);
    Kernel copy(device(), two_containers, "copy", from, sparks);
    require_complete(to.build([&] { copy.run(40, from, to); }), 4096);
    require_same(to.download(), oracle_of(inserts, 40));
    require_same(from.download(), oracle_of(inserts, 40));
}

}  // namespace
}  // namespace cellist::test
