// SPDX-License-Identifier: MIT
// build_slices builds lists that are more than the pool may hold, a range of cells at a time.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Downloads every slice, and requires that slices are in order, cover all cells, and leave no
/// record in the cells of other slices.
struct Collected {
    explicit Collected(Lists<Item>& from) : lists(from) {}
    void operator()(const Slice& slice) {
        REQUIRE(slice.first_cell == next_cell);
        REQUIRE(slice.cells > 0);
        next_cell += slice.cells;
        ++slices;
        lists.sort(&Item::key);
        const HostLists<Item> found = lists.download();
        require_sound(lists, found.records().size());
        for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
            for (const Item& item : found.cell(cell)) {
                REQUIRE(cell - slice.first_cell < slice.cells);
                all.emplace(cell, item);
            }
    }

    Lists<Item>& lists;
    std::uint64_t next_cell = 0;
    int slices = 0;
    Oracle<Item> all;
};

void require_equal(const Oracle<Item>& found, const Oracle<Item>& oracle, std::uint64_t cells) {
    REQUIRE(found.size() == oracle.size());
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
        const auto records_of = [&](const Oracle<Item>& lists) {
            std::vector<Item> records;
            const auto [begin, end] = lists.equal_range(cell);
            for (auto entry = begin; entry != end; ++entry) records.push_back(entry->second);
            return sorted_bytes<Item>(records);
        };
        if (records_of(found) != records_of(oracle)) FAIL("cell " << cell << " differs");
    }
}

TEST_CASE("slices together hold every record, whatever the pool may hold") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 230u);
    Inserts<Item> inserts = random_inserts(4096, 100, random);
    for (cl_uint i = 0; i < 20; ++i) inserts.add(144 + i, {});
    const Oracle<Item> oracle = oracle_of(inserts, 144);
    // The heads and counters take the rest of the budget.
    for (const std::uint64_t pool_bytes : {100'000u, 32'768u, 5'000u, 1'000u}) {
        INFO("pool of " << pool_bytes << " bytes");
        const Lists<Item> empty(device(), {16, 9},
                                {.storage = storage, .capacity_nodes = 0, .slots = 0});
        Lists<Item> lists(device(), {16, 9},
                          {.storage = storage,
                           .capacity_nodes = 0,
                           .slots = 0,
                           .budget_bytes = empty.pool_bytes() + pool_bytes});
        UploadedInserts scene(lists, inserts);
        Collected collected(lists);
        const BuildReport report =
            lists.build_slices([&] { scene.insert(lists); }, std::ref(collected));
        REQUIRE(collected.next_cell == 144);
        require_equal(collected.all, oracle, 144);
        require_complete({report.attempted, report.stored, report.dropped, report.rejected,
                          report.stored, report.passes},
                         4096, 20);
        REQUIRE(report.capacity_nodes * sizeof(Item) <= pool_bytes);
        REQUIRE(report.passes == 1u + static_cast<unsigned>(collected.slices) *
                                          (storage == Storage::counted ? 2u : 1u));
        if (pool_bytes == 100'000u && !has_slots(storage)) REQUIRE(collected.slices == 1);
        if (pool_bytes == 1'000u) REQUIRE(collected.slices > 30);
        require_sound(lists, 0);

        // The container is whole again.
        const Inserts<Item> few = random_inserts(60, 144, random);
        if (pool_bytes > 30'000u) {
            require_complete(Inserter(lists).build(lists, few), 60);
            require_same(lists.download(), oracle_of(few, 144));
        }
    }
}

TEST_CASE("slices keep within the capacity where the pool may not grow") {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    const Overflow overflow = GENERATE(Overflow::stop, Overflow::drop);
    INFO("storage " << name_of(storage));
    CELLIST_RANDOM(random, 231u);
    const Inserts<Item> inserts = random_inserts(4096, 100, random);
    Lists<Item> lists(device(), {100},
                      {.storage = storage, .overflow = overflow, .capacity_nodes = 300});
    UploadedInserts scene(lists, inserts);
    Collected collected(lists);
    const BuildReport report =
        lists.build_slices([&] { scene.insert(lists); }, std::ref(collected));
    REQUIRE(lists.capacity_nodes() == 300);
    REQUIRE(report.stored == 4096);
    REQUIRE(report.dropped == 0);
    REQUIRE(collected.slices >= 14);
    require_equal(collected.all, oracle_of(inserts, 100), 100);
}

TEST_CASE("a list that is longer than the pool throws, or is dropped from") {
    CELLIST_RANDOM(random, 232u);
    Inserts<Item> inserts = random_inserts(93, 50, random);
    for (cl_uint i = 0; i < 200; ++i) inserts.add(20, {0.0f, 93 + i});
    for (const Overflow overflow : {Overflow::stop, Overflow::drop}) {
        Lists<Item> lists(device(), {50}, {.overflow = overflow, .capacity_nodes = 100});
        UploadedInserts scene(lists, inserts);
        Collected collected(lists);
        const auto build = [&] {
            return lists.build_slices([&] { scene.insert(lists); }, std::ref(collected));
        };
        if (overflow == Overflow::stop) {
            const auto error = error_of<OverflowError>(build);
            INFO(error.what());
            REQUIRE(collected.next_cell == 20);
        } else {
            const BuildReport report = build();
            const std::uint64_t hot = oracle_of(inserts, 50).count(20);
            REQUIRE(report.attempted == 293);
            REQUIRE(report.dropped == hot - 100);
            REQUIRE(report.stored == 293 - report.dropped);
            REQUIRE(collected.all.size() == report.stored);
        }
        require_sound(lists, 0);
        require_complete(Inserter(lists).build(lists, random_inserts(60, 50, random)), 60);
    }
}

TEST_CASE("a list that is over the budget throws") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 236u);
    Inserts<Item> inserts = random_inserts(93, 50, random);
    for (cl_uint i = 0; i < 200; ++i) inserts.add(20, {0.0f, 93 + i});
    const Lists<Item> empty(device(), {50}, {.storage = storage, .capacity_nodes = 0, .slots = 0});
    const std::uint64_t hot = oracle_of(inserts, 50).count(20);
    const std::uint64_t node_bytes =
        sizeof(Item) + (storage == Storage::linked ? sizeof(cl_uint) : 0);
    for (const std::uint64_t missing_bytes : {0u, 1u}) {
        Lists<Item> lists(device(), {50},
                          {.storage = storage,
                           .capacity_nodes = 0,
                           .slots = 0,
                           .budget_bytes = empty.pool_bytes() + hot * node_bytes - missing_bytes});
        UploadedInserts scene(lists, inserts);
        Collected collected(lists);
        const auto build = [&] {
            return lists.build_slices([&] { scene.insert(lists); }, std::ref(collected));
        };
        if (missing_bytes > 0) {
            REQUIRE(contains(error_of<OverflowError>(build).what(), "budget_bytes"));
            REQUIRE(collected.next_cell == 20);
            require_sound(lists, 0);
        } else {
            REQUIRE(build().stored == 293);
        }
    }
}

TEST_CASE("an error inside of a slice leaves an empty container") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 233u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, {.storage = storage, .budget_bytes = 10'000});
    UploadedInserts scene(lists, inserts);
    const auto insert = [&] { scene.insert(lists); };
    int calls = 0;
    const auto error = error_of<std::runtime_error>([&] {
        lists.build_slices(insert, [&](const Slice&) {
            if (++calls == 3) throw std::runtime_error("enough");
        });
    });
    REQUIRE(std::string(error.what()) == "enough");
    require_sound(lists, 0);

    REQUIRE(contains(error_of([&] {
                         lists.build_slices(insert, [&](const Slice&) { lists.build(insert); });
                     }).what(),
                     "while a slice of it is read"));
    require_sound(lists, 0);
    require_complete(Inserter(lists).build(lists, random_inserts(60, 50, random)), 60);
}

TEST_CASE("a kernel that inserts other records into the slices than it counted is found") {
    CELLIST_RANDOM(random, 234u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    const Inserts<Item> fewer = random_inserts(4000, 50, random);
    Lists<Item> lists(device(), {50}, {.budget_bytes = 20'000});
    UploadedInserts scene(lists, inserts), other(lists, fewer);
    int calls = 0;
    const auto error = error_of([&] {
        lists.build_slices([&] { (++calls < 3 ? scene : other).insert(lists); },
                           [](const Slice&) {});
    });
    INFO(error.what());
    REQUIRE(contains(error.what(), "the same records"));
    require_sound(lists, 0);
}

TEST_CASE("a shape without cells has no slices") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 235u);
    Lists<Item> lists(device(), {0, 3}, {.storage = storage});
    UploadedInserts scene(lists, random_inserts(144, 50, random));
    const BuildReport report = lists.build_slices([&] { scene.insert(lists); },
                                                  [](const Slice&) { FAIL("there is no cell"); });
    REQUIRE(report.rejected == 144);
    REQUIRE(report.attempted == 144);
}

}  // namespace
}  // namespace cellist::test
