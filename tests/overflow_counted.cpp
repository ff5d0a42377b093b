// SPDX-License-Identifier: MIT
// Storage::counted makes room for exactly what it counted, or stops, or drops from the highest
// cells.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

TEST_CASE("counted grows to the exact demand") {
    CELLIST_RANDOM(random, 230u);
    const Inserts<Item> inserts = random_inserts(4096, 60, random);
    const Oracle<Item> oracle = oracle_of(inserts, 50);
    for (const std::uint64_t capacity : {std::uint64_t{0}, std::uint64_t{1}, oracle.size() - 1,
                                         oracle.size(), oracle.size() + 1}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(device(), {50},
                          {.storage = Storage::counted, .capacity_nodes = capacity});
        Inserter inserter(lists);
        for (int build = 0; build < 2; ++build) {
            const BuildReport report = inserter.build(lists, inserts);
            require_complete(report, oracle.size(), 4096 - oracle.size());
            REQUIRE(report.passes ==
                    passes_of(Storage::counted, build == 0 ? capacity : oracle.size()));
            REQUIRE(report.capacity_nodes == std::max<std::uint64_t>(capacity, oracle.size()));
            REQUIRE(lists.capacity_nodes() == report.capacity_nodes);
            require_sound(lists, oracle.size());
            require_same(lists.download(), oracle);
        }
    }
}

TEST_CASE("counted stops before it fills, and leaves the lists empty and usable") {
    CELLIST_RANDOM(random, 231u);
    for (const std::uint64_t capacity : {0u, 1u, 143u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(
            device(), {50},
            {.storage = Storage::counted, .overflow = Overflow::stop, .capacity_nodes = capacity});
        Inserter inserter(lists);
        Inserts<Item> inserts = random_inserts(144, 50, random);
        inserts.add(50, {0.0f, 144});
        const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
        INFO(error.what());
        REQUIRE(contains(error.what(), "pool of " + std::to_string(capacity) + " nodes"));
        REQUIRE(contains(error.what(), "144"));
        REQUIRE(contains(error.what(), "capacity_nodes"));
        REQUIRE(error.report().attempted == 145);
        REQUIRE(error.report().stored == capacity);
        REQUIRE(error.report().dropped == 144 - capacity);
        REQUIRE(error.report().rejected == 1);
        REQUIRE(error.report().passes == 1);

        REQUIRE(lists.capacity_nodes() == capacity);
        require_sound(lists, 0);
        REQUIRE(lists.download().records().empty());
        const Inserts<Item> fewer = random_inserts(capacity, 50, random);
        require_complete(inserter.build(lists, fewer), capacity);
        require_same(lists.download(), oracle_of(fewer, 50));
    }
}

TEST_CASE("counted drops from the cells with the highest indices") {
    CELLIST_RANDOM(random, 232u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    const Oracle<Item> oracle = oracle_of(inserts, 50);
    for (const std::uint64_t capacity : {0u, 1u, 93u, 2000u, 4095u, 4096u, 5000u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(
            device(), {50},
            {.storage = Storage::counted, .overflow = Overflow::drop, .capacity_nodes = capacity});
        const BuildReport report = Inserter(lists).build(lists, inserts);
        const std::uint64_t stored = std::min<std::uint64_t>(capacity, 4096);
        REQUIRE(report.attempted == 4096);
        REQUIRE(report.stored == stored);
        REQUIRE(report.dropped == 4096 - stored);
        REQUIRE(report.capacity_nodes == capacity);
        require_sound(lists, stored);
        const HostLists<Item> found = lists.download();
        std::uint64_t left = stored;
        for (std::uint64_t cell = 0; cell < 50; ++cell) {
            const std::uint64_t expected = std::min<std::uint64_t>(left, oracle.count(cell));
            REQUIRE(found.cell(cell).size() == expected);
            left -= expected;
            for (const Item& item : found.cell(cell)) {
                REQUIRE(inserts.cells[item.id] == cell);
                REQUIRE(inserts.records[item.id] == item);
            }
        }
    }
}

TEST_CASE("the budget bounds how far counted grows") {
    CELLIST_RANDOM(random, 233u);
    const std::uint64_t exact =
        Lists<Item>(device(), {50}, {.storage = Storage::counted, .capacity_nodes = 4096})
            .pool_bytes();
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> fits(device(), {50}, {.storage = Storage::counted, .budget_bytes = exact});
    require_complete(Inserter(fits).build(fits, inserts), 4096);
    REQUIRE(fits.pool_bytes() == exact);

    Lists<Item> lists(device(), {50}, {.storage = Storage::counted, .budget_bytes = exact - 1});
    Inserter inserter(lists);
    const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
    INFO(error.what());
    REQUIRE(contains(error.what(), std::to_string(exact)));
    REQUIRE(contains(error.what(), std::to_string(exact - 1)));
    REQUIRE(error.report().attempted == 4096);
    require_sound(lists, 0);
    require_complete(inserter.build(lists, random_inserts(3000, 50, random)), 3000);
}

}  // namespace
}  // namespace cellist::test
