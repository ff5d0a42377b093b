// SPDX-License-Identifier: MIT
// Every kernel of the library once, at sizes that a simulator runs in seconds. ctest runs these
// tests under Oclgrind too, which reports invalid accesses and data races.
#include "support/appends.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("a small container is built, grown, sorted, validated and downloaded", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 170u);
    const Inserts<Item> inserts = random_inserts(200, 13, random);
    Lists<Item> lists(device(), {4, 3}, {.storage = storage, .capacity_nodes = 150});
    const Oracle<Item> oracle = oracle_of(inserts, 12);
    const BuildReport report = Inserter(lists).build(lists, inserts);
    require_complete(report, oracle.size(), 200 - oracle.size());
    REQUIRE(report.passes == 2);
    lists.sort(&Item::key);
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
}

TEST_CASE("a small container takes appends, and loses records", "[oclgrind]") {
    const StorageOption storage =
        GENERATE(StorageOption(Storage::linked), StorageOption(Storage::counted),
                 StorageOption(Storage::fixed), nearest(&Item::key, 40));
    const Overflow overflow = storage == Storage::counted ? Overflow::drop : Overflow::grow;
    CELLIST_RANDOM(random, 174u);
    Lists<Item> lists(device(), {10},
                      {.storage = storage,
                       .overflow = overflow,
                       .capacity_nodes = overflow == Overflow::grow ? 60 : 300,
                       .slots = overflow == Overflow::grow ? 5 : 40});
    Inserter inserter(lists);
    Oracle<Item> oracle;
    for (int again = 0; again < 3; ++again) {
        const Inserts<Item> inserts = random_inserts(60, 10, random);
        const BuildReport report = append(inserter, lists, inserts);
        REQUIRE(report.existing == oracle.size());
        oracle.merge(oracle_of(inserts, 10));
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
    }
    REQUIRE_THROWS_AS(lists.append([&] {
        inserter.run(lists, random_inserts(20, 10, random));
        throw std::runtime_error("the caller's own");
    }),
                      std::runtime_error);
    require_same(lists.download(), oracle);
    const Lists<Item> copy = lists.copy();
    require_same(copy.download(), oracle);
    lists.remove_if("record.id >= 10");
    REQUIRE(lists.device_histogram(300).download()[3] + lists.device_offsets().download()[10] > 0);
    REQUIRE(lists.merge(copy).stored == oracle.size() + 30);
}

TEST_CASE("a small pool of several shards overflows", "[oclgrind]") {
    CELLIST_RANDOM(random, 171u);
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(
        device(), {10},
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 2100, .slots = 190});
    const BuildReport report = Inserter(lists).build(lists, random_inserts(2200, 10, random));
    if (!has_slots(storage)) REQUIRE(report.stored == 2100);
    REQUIRE(report.dropped > 0);
    REQUIRE(report.stored + report.dropped == 2200);
    require_sound(lists, report.stored);
}

TEST_CASE("a small container chooses its storage", "[oclgrind]") {
    CELLIST_RANDOM(random, 173u);
    const Inserts<Item> inserts = random_inserts(93, 10, random);
    Lists<Item> lists(device(), {10}, {.storage = Storage::automatic});
    Inserter inserter(lists);
    for (int build = 0; build < 13; ++build) {
        inserter.build(lists, inserts);
        require_same(lists.download(), oracle_of(inserts, 10));
    }
}

TEST_CASE("the nearest records of small lists are taken", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 172u);
    Lists<Item> lists(device(), {10}, {.storage = storage});
    Inserter(lists).build(lists, random_inserts(93, 10, random));
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void nearest(CELLIST_LISTS(Item, lists), global uint* sorted)
{
    Item out[4];
    const uint cell = get_global_id(0);
    const uint found = cellist_nearest(lists, cell, key, 4, out);
    sorted[cell] = found;
    for (uint i = 1; i < found; ++i)
        if (out[i - 1].key > out[i].key) sorted[cell] = 99;
}
)",
                  "nearest", lists);
    const Buffer<cl_uint> sorted(device(), 10);
    kernel.run(10, lists, sorted);
    const HostLists<Item> host = lists.download();
    const std::vector<cl_uint> found = sorted.download();
    for (std::uint64_t cell = 0; cell < 10; ++cell)
        REQUIRE(found[cell] == std::min<std::size_t>(4, host.cell(cell).size()));
}

}  // namespace
}  // namespace cellist::test
