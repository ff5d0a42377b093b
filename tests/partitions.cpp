// SPDX-License-Identifier: MIT
// Storage::counted in one pass, on processors: threads put records into partitions of the cells,
// and the library moves them. Elsewhere the same builds count and fill.
#include <functional>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

struct Word {
    cl_uint id;
};
CELLIST_STRUCT(Word, id);

struct WideRecord {
    cl_double at;
    cl_float color[4];
    cl_uint id;
    cl_uint other;
};
CELLIST_STRUCT(WideRecord, at, color, id, other);

Word make(cl_uint id, const Word*) { return {id}; }
Item make(cl_uint id, const Item*) { return {static_cast<cl_float>(id % 97), id}; }
WideRecord make(cl_uint id, const WideRecord*) {
    return {0.5 * id, {1.0f, 2.0f, 3.0f, 4.0f}, id, ~id};
}

/// Which cell the i-th record goes to: any, neighbours by turns, runs, or one.
cl_uint cell_of(std::uint32_t pattern, std::uint32_t i, std::uint32_t cells, std::mt19937& random) {
    if (pattern == 0) return below(random, cells);
    if (pattern == 1) return i % cells;
    if (pattern == 2) return i / 16 * 7 % cells;
    return cells / 3;
}

template <class T>
void build_twice(std::uint32_t cells, std::uint32_t pattern, std::uint32_t count) {
    CELLIST_RANDOM(random, 900u + pattern);
    Inserts<T> inserts;
    for (std::uint32_t i = 0; i < count; ++i)
        inserts.add(cell_of(pattern, i, cells, random), make(i, static_cast<const T*>(nullptr)));
    for (std::uint32_t i = 0; i < 5; ++i) inserts.add(cells + i, inserts.records[i]);
    INFO(cells << " cells, pattern " << pattern << ", " << count << " records");
    Lists<T> lists(device(), {cells}, {.storage = Storage::counted});
    Inserter<T> inserter(lists);
    for (int build = 0; build < 3; ++build) {
        const BuildReport report = inserter.build(lists, inserts);
        require_complete(report, count, 5);
        REQUIRE(report.passes == (build == 0 ? 2 : passes_of(Storage::counted, count)));
        require_sound(lists, count);
        require_same(lists.download(), oracle_of(inserts, cells));
        if (build == 1) lists.sort(&T::id);
    }
}

TEST_CASE("builds in one pass hold the records of every size, pattern and number of cells") {
    for (const std::uint32_t pattern : {0u, 1u, 2u, 3u}) {
        for (const std::uint32_t cells : {1u, 2u, 513u, 40'000u}) {
            build_twice<Item>(cells, pattern, 30'000);
            build_twice<Item>(cells, pattern, 2048);
        }
        build_twice<Word>(1000, pattern, 100'001);
        if (device().info().fp64) build_twice<WideRecord>(1000, pattern, 10'000);
    }
}

constexpr auto several_source = R"(
#include <cellist/lists.clh>

// Every work-item inserts `each` records, in divergent control flow.
kernel void several(CELLIST_LISTS(Item, lists), uint each)
{
    const uint i = get_global_id(0), n = get_global_size(0), cells = cellist_cells(lists);
    for (uint j = 0; j < each; ++j) {
        const Item item = { (float)j, j * n + i };
        const uint cell = (i * 31 + j * 7) % cells;
        if (j % 2) cellist_insert(lists, cell, item);
        else if (i % 3) cellist_insert(lists, cell, item);
        else cellist_insert(lists, cells - 1 - cell, item);
    }
    const Item last = { -1.0f, each * n + i };
    if (i % 5 != 0) cellist_insert(lists, i % cells, last);
}
)";

TEST_CASE("several inserts and several kernels share the partitions of a build") {
    constexpr cl_uint items = 4096;
    constexpr cl_uint cells = 700;
    Lists<Item> lists(device(), {cells}, {.storage = Storage::counted});
    Kernel kernel(device(), several_source, "several", lists);
    std::vector<unsigned> expected(cells);
    std::uint64_t total = 0;
    const auto expect = [&](cl_uint cell) { ++expected[cell], ++total; };
    const std::vector<cl_uint> runs{3, 1, 8};
    for (const cl_uint each : runs)
        for (cl_uint i = 0; i < items; ++i) {
            for (cl_uint j = 0; j < each; ++j) {
                const cl_uint cell = (i * 31 + j * 7) % cells;
                expect(j % 2 || i % 3 ? cell : cells - 1 - cell);
            }
            if (i % 5 != 0) expect(i % cells);
        }
    for (int build = 0; build < 3; ++build) {
        const BuildReport report = lists.build([&] {
            for (const cl_uint each : runs) kernel.run(items, lists, each);
        });
        require_complete(report, total);
        REQUIRE(report.passes == (build == 0 ? 2 : passes_of(Storage::counted, total)));
        require_sound(lists, total);
        const HostLists<Item> found = lists.download();
        for (cl_uint cell = 0; cell < cells; ++cell)
            REQUIRE(found.cell(cell).size() == expected[cell]);
    }
}

TEST_CASE("partitions grow with the records, in as few passes as there can be") {
    CELLIST_RANDOM(random, 910u);
    Lists<Item> lists(device(), {300}, {.storage = Storage::counted});
    Inserter<Item> inserter(lists);
    std::uint64_t most = 0;
    for (const std::uint32_t count : {20'000u, 21'000u, 90'000u, 90'000u, 500u, 0u, 100'000u}) {
        INFO(count << " records after " << most);
        const Inserts<Item> inserts = random_inserts(count, 300, random);
        const BuildReport report = inserter.build(lists, inserts);
        require_complete(report, count);
        // An eighth more than before has room in the partitions, and blocks that nothing else
        // needs.
        const std::uint32_t passes = passes_of(Storage::counted, most);
        REQUIRE(report.passes == (passes == 1 && count > most + most / 4 ? 2 : passes));
        most = std::max<std::uint64_t>(most, count);
        REQUIRE(report.capacity_nodes == most);
        REQUIRE(lists.capacity_nodes() == most);
        require_sound(lists, count);
        require_same(lists.download(), oracle_of(inserts, 300));
    }
}

TEST_CASE("kernels that know no threads count and fill") {
    CELLIST_RANDOM(random, 911u);
    const Inserts<Item> inserts = random_inserts(50'000, 300, random);
    const Buffer<cl_uint> cells(device(), inserts.cells);
    const Buffer<Item> records(device(), inserts.records);
    Lists<Item> lists(device(), {300}, {.storage = Storage::counted});
    Kernel kernel(
        device(),
        Source{.text = insert_source("Item"), .options = "-DCELLIST_ONE_THREAD_PER_WORK_GROUP=0"},
        "insert_all", lists);
    for (int build = 0; build < 4; ++build) {
        const BuildReport report =
            lists.build(kernel, inserts.size(), cells, records, cl_uint{50'000});
        require_complete(report, 50'000);
        // One of them finds out.
        const bool tries = passes_of(Storage::counted, 50'000) == 1;
        REQUIRE(report.passes == (build == 1 && tries ? 3 : 2));
        require_sound(lists, 50'000);
        require_same(lists.download(), oracle_of(inserts, 300));
    }
}

TEST_CASE("partitions stay within the budget, and builds count where it has no room for them") {
    CELLIST_RANDOM(random, 912u);
    const Inserts<Item> inserts = random_inserts(50'000, 300, random);
    const Inserts<Item> more = random_inserts(53'000, 300, random);
    for (const std::uint64_t budget : {450'000u, 1'300'000u, 1'500'000u, 4'000'000u}) {
        INFO("budget of " << budget);
        Lists<Item> lists(device(), {300}, {.storage = Storage::counted, .budget_bytes = budget});
        Inserter<Item> inserter(lists);
        for (const Inserts<Item>* what : {&inserts, &inserts, &more, &inserts}) {
            require_complete(inserter.build(lists, *what), what->size());
            REQUIRE(lists.pool_bytes() <= budget);
            require_sound(lists, what->size());
            require_same(lists.download(), oracle_of(*what, 300));
        }
        const std::uint32_t passes = inserter.build(lists, inserts).passes;
        REQUIRE(passes == (budget < 1'300'000 ? 2 : passes_of(Storage::counted, 53'000)));
    }
}

TEST_CASE("what does not fit the budget leaves empty lists, with the partitions or without") {
    CELLIST_RANDOM(random, 913u);
    const Inserts<Item> inserts = random_inserts(50'000, 300, random);
    Lists<Item> lists(device(), {300}, {.storage = Storage::counted, .budget_bytes = 4'000'000});
    Inserter<Item> inserter(lists);
    for (int build = 0; build < 2; ++build) {
        require_complete(inserter.build(lists, inserts), 50'000);
        const Inserts<Item> many = random_inserts(600'000, 300, random);
        const auto error = error_of<OverflowError>([&] { inserter.build(lists, many); });
        REQUIRE(contains(error.what(), "600000 nodes"));
        REQUIRE(contains(error.what(), "budget"));
        REQUIRE(error.report().attempted == 600'000);
        require_sound(lists, 0);
    }
    require_complete(inserter.build(lists, inserts), 50'000);
    require_same(lists.download(), oracle_of(inserts, 300));
}

TEST_CASE("the report of a build that fails says what the pool could hold") {
    CELLIST_RANDOM(random, 915u);
    Lists<Item> lists(
        device(), {300},
        {.storage = Storage::counted, .capacity_nodes = 80'000, .budget_bytes = 4'000'000});
    const Inserts<Item> many = random_inserts(600'000, 300, random);
    const auto error = error_of<OverflowError>([&] { Inserter<Item>(lists).build(lists, many); });
    REQUIRE(error.report().stored == 80'000);
    REQUIRE(error.report().dropped == 520'000);
    REQUIRE(error.report().attempted == 600'000);
    require_sound(lists, 0);
}

TEST_CASE("the function that inserts cannot use the container otherwise") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 916u);
    const Inserts<Item> inserts = random_inserts(20'000, 300, random);
    Lists<Item> lists(device(), {300}, {.storage = storage});
    Inserter<Item> inserter(lists);
    const std::vector<std::function<void()>> uses{[&] { lists.clear(); },
                                                  [&] { static_cast<void>(lists.validate()); },
                                                  [&] { lists.sort(&Item::key); },
                                                  [&] { lists.sort_async(&Item::key); },
                                                  [&] { static_cast<void>(lists.download()); },
                                                  [&] { static_cast<void>(lists.lengths()); },
                                                  [&] { static_cast<void>(lists.pack()); }};
    for (const std::function<void()>& use : uses) {
        require_complete(inserter.build(lists, inserts), 20'000);
        const auto error = error_of<Error>([&] {
            lists.build([&] {
                inserter.run(lists, inserts);
                use();
            });
        });
        REQUIRE(contains(error.what(), "while it is built"));
        require_sound(lists, 0);
    }
    require_complete(inserter.build(lists, inserts), 20'000);
    require_same(lists.download(), oracle_of(inserts, 300));
}

TEST_CASE("lists are read as usual in the kernels of other builds, and as empty in their own") {
    CELLIST_RANDOM(random, 914u);
    const Inserts<Item> inserts = random_inserts(20'000, 50, random);
    Lists<Item> lists(device(), {50}, {.storage = Storage::counted});
    Inserter<Item> inserter(lists);
    for (int build = 0; build < 2; ++build) inserter.build(lists, inserts);
    Kernel copy(device(), R"(
#include <cellist/lists.clh>
kernel void copy(CELLIST_LISTS(Item, from), CELLIST_LISTS(Item, to))
{
    const uint cell = get_global_id(0);
    cellist_for_each(from, cell, node) cellist_insert(to, cell, cellist_get(from, node));
}
)",
                "copy", lists);
    Lists<Item> copied(device(), {50}, {.storage = Storage::counted});
    for (int build = 0; build < 3; ++build) {
        require_complete(copied.build([&] { copy.run(50, lists, copied); }), 20'000);
        require_sound(copied, 20'000);
        require_same(copied.download(), oracle_of(inserts, 50));
    }
    for (int build = 0; build < 2; ++build) {
        require_complete(copied.build([&] { copy.run(50, copied, copied); }), 0);
        require_sound(copied, 0);
    }
}

}  // namespace
}  // namespace cellist::test
