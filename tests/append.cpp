// SPDX-License-Identifier: MIT
// append() keeps the records that are in the lists, and reports both exactly.
#include "support/appends.hpp"
#include "support/errors.hpp"
#include "support/internals.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Requires the report of an append in which all records fit.
void require_appended(const BuildReport& report, std::uint64_t existing, std::uint64_t added,
                      std::uint64_t rejected = 0) {
    REQUIRE(report.existing == existing);
    REQUIRE(report.attempted == added + rejected);
    REQUIRE(report.stored == existing + added);
    REQUIRE(report.dropped == 0);
    REQUIRE(report.rejected == rejected);
}

TEST_CASE("appends add their records to those that are there") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 400u);
    for (const Shape& shape : {Shape{50}, Shape{1}, Shape{40, 40}}) {
        INFO("shape " << shape.to_string());
        Lists<Item> lists(device(), shape, {.storage = storage});
        Inserter inserter(lists);
        Oracle<Item> oracle;
        for (const std::size_t count : {0u, 1u, 93u, 0u, 4096u, 7u, 144u}) {
            // A tenth of the records is for cells outside of the shape.
            const auto cells = static_cast<cl_uint>(shape.cells());
            const Inserts<Item> inserts = random_inserts(count, cells + cells / 10 + 1, random);
            const Oracle<Item> added = oracle_of(inserts, shape.cells());
            const BuildReport report = append(inserter, lists, inserts);
            require_appended(report, oracle.size(), added.size(), count - added.size());
            oracle.insert(added.begin(), added.end());
            require_sound(lists, oracle.size());
            require_same(lists.download(), oracle);
        }
        const Inserts<Item> inserts = random_inserts(100, 1, random);
        require_complete(inserter.build(lists, inserts), 100);
        require_same(lists.download(), oracle_of(inserts, shape.cells()));
    }
}

TEST_CASE("a pool that is too small for an append grows, and keeps each record once") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 401u);
    for (const std::size_t count : {1u, 100u, 3000u, 70'000u}) {
        INFO(count << " records");
        Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 200, .slots = 4});
        Inserter inserter(lists);
        const Inserts<Item> first = random_inserts(200, 50, random);
        inserter.build(lists, first);
        const Inserts<Item> second = random_inserts(count, 50, random);
        require_appended(append(inserter, lists, second), 200, count);
        Oracle<Item> oracle = oracle_of(first, 50);
        oracle.merge(oracle_of(second, 50));
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);

        require_appended(append(inserter, lists, first), 200 + count, 200);
        oracle.merge(oracle_of(first, 50));
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
    }
}

TEST_CASE("lists built in regions or partitions take appends, and the next build is one pass") {
    CELLIST_RANDOM(random, 413u);
    for (const bool as_gpu : {true, false}) {
        const Device on = as_gpu ? like_gpu() : Device::choose();
        Lists<Item> lists(on, {20'000}, {.storage = Storage::counted});
        Inserter inserter(lists, on);
        for (int step = 0; step < 3; ++step) {
            const Inserts<Item> built = random_inserts(200'000, 20'000, random);
            const BuildReport report = inserter.build(lists, built);
            if (step > 0 && (as_gpu || passes_of(Storage::counted, 300'000) == 1))
                REQUIRE(report.passes == 1);
            Oracle<Item> oracle = oracle_of(built, 20'000);
            for (const std::size_t count : {7u, 5000u, 100'000u}) {
                const Inserts<Item> inserts = random_inserts(count, 20'000, random);
                require_appended(append(inserter, lists, inserts), oracle.size(), count);
                oracle.merge(oracle_of(inserts, 20'000));
                require_sound(lists, oracle.size());
                require_same(lists.download(), oracle);
            }
        }
    }
}

TEST_CASE("lists of any length move when counted lists grow") {
    CELLIST_RANDOM(random, 414u);
    constexpr cl_uint cells = 5000;
    for (const bool as_gpu : {true, false}) {
        const Device on = as_gpu ? like_gpu() : Device::choose();
        for (const cl_uint longest : {1u, 63u, 511u, 512u, 513u, 70'000u}) {
            INFO((as_gpu ? "GPU, " : "") << longest << " records in a list");
            Lists<Item> lists(on, {cells}, {.storage = Storage::counted});
            Inserter inserter(lists, on);
            Inserts<Item> first;
            for (const cl_uint cell : {0u, 7u, 8u, 3000u, cells - 1})
                for (cl_uint i = 0; i < longest; ++i) first.add(cell, {1.0f, i});
            require_complete(inserter.build(lists, first), first.size());
            Oracle<Item> oracle = oracle_of(first, cells);
            for (int step = 0; step < 3; ++step) {
                Inserts<Item> more = random_inserts(100, cells, random);
                more.add(7, {2.0f, longest});
                require_appended(append(inserter, lists, more), oracle.size(), more.size());
                oracle.merge(oracle_of(more, cells));
                require_sound(lists, oracle.size());
                require_same(lists.download(), oracle);
            }
        }
    }
}

TEST_CASE("the pool of an append may need the memory of regions") {
    CELLIST_RANDOM(random, 415u);
    const Device gpu = like_gpu();
    const Inserts<Item> first = random_inserts(70'000, 5000, random);
    const Inserts<Item> second = random_inserts(7000, 5000, random);
    const auto bytes_after_builds = [&](std::uint64_t budget) {
        Lists<Item> lists(gpu, {5000}, {.storage = Storage::counted, .budget_bytes = budget});
        Inserter inserter(lists, gpu);
        for (int build = 0; build < 2; ++build) inserter.build(lists, first);
        const std::uint64_t bytes = lists.pool_bytes();
        require_appended(append(inserter, lists, second), first.size(), second.size());
        REQUIRE(lists.pool_bytes() <= budget);
        Oracle<Item> oracle = oracle_of(first, 5000);
        oracle.merge(oracle_of(second, 5000));
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
        require_complete(inserter.build(lists, first), first.size());
        REQUIRE(lists.pool_bytes() <= budget);
        return bytes;
    };
    const std::uint64_t exact = bytes_after_builds(std::uint64_t{1} << 30);
    bytes_after_builds(exact);
    bytes_after_builds(exact + second.size() * sizeof(Item) / 2);
}

TEST_CASE("pools grow by half, so that few of many appends move the records") {
    CELLIST_RANDOM(random, 402u);
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 1000});
    Inserter inserter(lists);
    inserter.build(lists, random_inserts(1000, 50, random));
    std::uint32_t grown = 0;
    for (std::uint64_t i = 1; i <= 100; ++i) {
        const BuildReport report = append(inserter, lists, random_inserts(100, 50, random));
        require_appended(report, 900 + 100 * i, 100);
        grown += report.passes - 1;
    }
    REQUIRE(grown == 6);
    require_sound(lists, 11'000);
}

TEST_CASE("a budget bounds an append to the exact demand") {
    CELLIST_RANDOM(random, 403u);
    const std::uint64_t exact = [&] {
        Lists<Item> lists(device(), {50}, {.capacity_nodes = 1100});
        Inserter inserter(lists);
        append(inserter, lists, random_inserts(1, 50, random));
        append(inserter, lists, random_inserts(1, 50, random));
        return lists.pool_bytes();
    }();
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 1000, .budget_bytes = exact});
    Inserter inserter(lists);
    const Inserts<Item> first = random_inserts(1000, 50, random);
    const Inserts<Item> second = random_inserts(100, 50, random);
    inserter.build(lists, first);
    const BuildReport report = append(inserter, lists, second);
    require_appended(report, 1000, 100);
    REQUIRE(report.capacity_nodes == 1100);
    Oracle<Item> oracle = oracle_of(first, 50);
    oracle.merge(oracle_of(second, 50));
    require_same(lists.download(), oracle);

    const auto error = error_of<OverflowError>([&] { append(inserter, lists, second); });
    REQUIRE(error.report().existing == 1100);
    REQUIRE(error.report().attempted == 100);
    require_sound(lists, 1100);
    require_same(lists.download(), oracle);
}

TEST_CASE("an append that is stopped leaves the existing records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 404u);
    Lists<Item> lists(
        device(), {50},
        {.storage = storage, .overflow = Overflow::stop, .capacity_nodes = 1000, .slots = 20});
    Inserter inserter(lists);
    Inserts<Item> first;
    for (cl_uint i = 0; i < 900; ++i) first.add(i % 50, {1.0f, i});
    inserter.build(lists, first);
    const Inserts<Item> second = random_inserts(144, 50, random);
    const auto error = error_of<OverflowError>([&] { append(inserter, lists, second); });
    REQUIRE(error.report().existing == 900);
    REQUIRE(error.report().attempted == 144);
    REQUIRE(error.report().dropped > 0);
    require_sound(lists, 900);
    require_same(lists.download(), oracle_of(first, 50));

    const Inserts<Item> third = random_inserts(50, 50, random);
    Oracle<Item> oracle = oracle_of(first, 50);
    for (cl_uint i = 0; i < 50; ++i) oracle.emplace(i, third.records[i]);
    Inserts<Item> spread;
    for (cl_uint i = 0; i < 50; ++i) spread.add(i, third.records[i]);
    require_appended(append(inserter, lists, spread), 900, 50);
    require_sound(lists, 950);
    require_same(lists.download(), oracle);
}

TEST_CASE("under drop, an append drops new records only") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 405u);
    for (const bool dropped_before : {false, true}) {
        Lists<Item> lists(
            device(), {50},
            {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 1000, .slots = 20});
        Inserter inserter(lists);
        inserter.build(lists, random_inserts(dropped_before ? 1100 : 900, 50, random));
        Oracle<Item> oracle = oracle_in(lists);
        for (int again = 0; again < 3; ++again) {
            const std::uint64_t existing = oracle.size();
            const Inserts<Item> inserts = random_inserts(200, 60, random);
            const BuildReport report = append(inserter, lists, inserts);
            REQUIRE(report.existing == existing);
            REQUIRE(report.attempted == 200);
            REQUIRE(report.existing + report.attempted ==
                    report.stored + report.dropped + report.rejected);
            REQUIRE(report.rejected == 200 - oracle_of(inserts, 50).size());
            require_sound(lists, report.stored);
            if (!has_slots(storage))
                REQUIRE(report.stored ==
                        std::min<std::uint64_t>(1000, existing + 200 - report.rejected));
            const Oracle<Item> found = oracle_in(lists);
            require_contains(found, oracle);
            Oracle<Item> all = oracle;
            all.merge(oracle_of(inserts, 50));
            require_contains(all, found);
            oracle = found;
        }
    }
}

TEST_CASE("the nearest of the existing and the new records stay") {
    CELLIST_RANDOM(random, 406u);
    Lists<Item> lists(device(), {20}, {.storage = nearest(&Item::key, 5)});
    Inserter inserter(lists);
    std::vector<std::vector<Item>> all(20);
    cl_uint id = 0;
    for (const std::size_t count : {93u, 1u, 4096u, 7u}) {
        Inserts<Item> inserts = random_inserts(count, 22, random);
        for (Item& item : inserts.records) item.id = id++;
        std::uint64_t existing = 0;
        for (const auto& list : all) existing += list.size();
        for (std::size_t i = 0; i < count; ++i)
            if (inserts.cells[i] < 20) all[inserts.cells[i]].push_back(inserts.records[i]);
        std::uint64_t stored = 0;
        for (auto& list : all) {
            std::sort(list.begin(), list.end(), [](const Item& a, const Item& b) {
                return std::pair(a.key, a.id) < std::pair(b.key, b.id);
            });
            list.resize(std::min<std::size_t>(list.size(), 5));
            stored += list.size();
        }
        const std::uint64_t rejected = count - oracle_of(inserts, 20).size();
        const BuildReport report = append(inserter, lists, inserts);
        REQUIRE(report.existing == existing);
        REQUIRE(report.attempted == count);
        REQUIRE(report.rejected == rejected);
        REQUIRE(report.stored == stored);
        REQUIRE(report.dropped == existing + count - rejected - stored);
        require_sound(lists, stored);
        Oracle<Item> oracle;
        for (std::size_t cell = 0; cell < all.size(); ++cell)
            for (const Item& item : all[cell]) oracle.emplace(cell, item);
        require_same(lists.download(), oracle);
    }
}

TEST_CASE("sorted lists take appends, and sort again") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 407u);
    for (const std::uint64_t capacity : {4096u, 5000u, 100'000u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = capacity});
        Inserter inserter(lists);
        Oracle<Item> oracle;
        for (int again = 0; again < 4; ++again) {
            const Inserts<Item> inserts = random_inserts(again == 0 ? 4096 : 500, 50, random);
            require_appended(append(inserter, lists, inserts), oracle.size(), inserts.size());
            oracle.merge(oracle_of(inserts, 50));
            lists.sort(&Item::key);
            require_sound(lists, oracle.size());
            const HostLists<Item> found = lists.download();
            require_same(found, oracle);
            for (std::uint64_t cell = 0; cell < 50; ++cell)
                REQUIRE(std::is_sorted(found.cell(cell).begin(), found.cell(cell).end(),
                                       [](const Item& a, const Item& b) { return a.key < b.key; }));
        }
    }
}

TEST_CASE("an append of several kernels runs all of them again after the pool has grown") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 408u);
    Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 150, .slots = 2});
    Inserter inserter(lists);
    const Inserts<Item> first = random_inserts(150, 50, random);
    const Inserts<Item> second = random_inserts(144, 50, random);
    const Inserts<Item> third = random_inserts(93, 50, random);
    inserter.build(lists, first);
    const BuildReport report = lists.append([&] {
        inserter.run(lists, second);
        inserter.run(lists, third);
    });
    require_appended(report, 150, 237);
    Oracle<Item> oracle = oracle_of(first, 50);
    oracle.merge(oracle_of(second, 50));
    oracle.merge(oracle_of(third, 50));
    require_sound(lists, 387);
    require_same(lists.download(), oracle);
}

TEST_CASE("an exception out of the inserting code leaves the existing records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 409u);
    for (const Overflow overflow : {Overflow::grow, Overflow::stop, Overflow::drop}) {
        Lists<Item> lists(
            device(), {50},
            {.storage = storage, .overflow = overflow, .capacity_nodes = 1000, .slots = 30});
        Inserter inserter(lists);
        const Inserts<Item> first = random_inserts(900, 50, random);
        inserter.build(lists, first);
        lists.sort(&Item::key);
        const HostLists<Item> sorted = lists.download();
        REQUIRE_THROWS_AS(lists.append([&] {
            inserter.run(lists, random_inserts(144, 60, random));
            throw std::runtime_error("the caller's own");
        }),
                          std::runtime_error);
        require_sound(lists, sorted.records().size());
        REQUIRE(lists.download().records() == sorted.records());
        const Inserts<Item> second = random_inserts(50, 50, random);
        REQUIRE(append(inserter, lists, second).existing == sorted.records().size());
    }
}

TEST_CASE("late inserts before an append are forgotten, and those after it are found") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 410u);
    Lists<Item> lists(device(), {50}, {.storage = storage});
    Inserter inserter(lists);
    const Inserts<Item> inserts = random_inserts(93, 50, random);
    inserter.build(lists, inserts);
    inserter.run(lists, inserts);
    REQUIRE(lists.validate().late_inserts == 93);
    append(inserter, lists, inserts);
    REQUIRE(lists.validate().late_inserts == 0);
    inserter.run(lists, inserts);
    REQUIRE(lists.validate().late_inserts == 93);
    REQUIRE(lists.lengths().total == 186);
}

TEST_CASE("the lists of a slice take no appends") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 411u);
    Lists<Item> lists(device(), {50}, {.storage = storage});
    Inserter inserter(lists);
    const Inserts<Item> inserts = random_inserts(93, 50, random);
    lists.build_slices([&] { inserter.run(lists, inserts); },
                       [&](const Slice&) {
                           REQUIRE_THROWS_AS(append(inserter, lists, inserts), Error);
                           REQUIRE_THROWS_AS(lists.copy(), Error);
                           REQUIRE_THROWS_AS(lists.remove_if("1"), Error);
                           REQUIRE(lists.lengths().total == 93);
                       });
    require_appended(append(inserter, lists, inserts), 0, 93);
}

TEST_CASE("a kernel that does not repeat itself leaves the existing records") {
    CELLIST_RANDOM(random, 412u);
    const StorageOption storage =
        GENERATE(StorageOption(Storage::counted), nearest(&Item::key, 1000));
    Lists<Item> lists(device(), {50}, {.storage = storage});
    Inserter inserter(lists);
    const Inserts<Item> first = random_inserts(93, 50, random);
    inserter.build(lists, first);
    int calls = 0;
    REQUIRE_THROWS_AS(lists.append([&] {
        inserter.run(lists, random_inserts(++calls == 1 ? 7 : 8, 50, random));
    }),
                      Error);
    require_sound(lists, 93);
    require_same(lists.download(), oracle_of(first, 50));
}

}  // namespace
}  // namespace cellist::test
