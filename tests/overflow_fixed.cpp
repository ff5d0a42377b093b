// SPDX-License-Identifier: MIT
// Storage::fixed raises its slots to the longest list, or stops, or keeps what fits into each cell.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

std::uint64_t longest_of(const Oracle<Item>& oracle, std::uint64_t cells) {
    std::uint64_t longest = 0;
    for (std::uint64_t cell = 0; cell < cells; ++cell)
        longest = std::max<std::uint64_t>(longest, oracle.count(cell));
    return longest;
}

TEST_CASE("slots grow to the longest list in a second pass") {
    CELLIST_RANDOM(random, 240u);
    const Inserts<Item> inserts = random_inserts(4096, 60, random);
    const Oracle<Item> oracle = oracle_of(inserts, 50);
    const auto longest = static_cast<std::uint32_t>(longest_of(oracle, 50));
    for (const std::uint32_t slots : {0u, 1u, longest - 1, longest, longest + 1}) {
        INFO("slots " << slots << ", longest list " << longest);
        Lists<Item> lists(device(), {50}, {.storage = Storage::fixed, .slots = slots});
        REQUIRE(lists.capacity_nodes() == 50u * slots);
        Inserter inserter(lists);
        const BuildReport report = inserter.build(lists, inserts);
        require_complete(report, oracle.size(), 4096 - oracle.size());
        REQUIRE(report.passes == (slots < longest ? 2 : 1));
        REQUIRE(report.capacity_nodes == 50 * std::max(slots, longest));
        REQUIRE(lists.capacity_nodes() == report.capacity_nodes);
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
        REQUIRE(inserter.build(lists, inserts).passes == 1);
    }
}

TEST_CASE("one long list raises the slots of every cell") {
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 1000; ++i) inserts.add(7, {0.0f, i});
    Lists<Item> lists(device(), {10}, {.storage = Storage::fixed});
    require_complete(Inserter(lists).build(lists, inserts), 1000);
    REQUIRE(lists.capacity_nodes() == 10'000);
    require_sound(lists, 1000);
}

TEST_CASE("too few slots stop a build, naming the slots and the longest list") {
    CELLIST_RANDOM(random, 241u);
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 144; ++i) inserts.add(i % 9, {0.0f, i});
    inserts.add(9, {0.0f, 144});
    for (const std::uint32_t slots : {0u, 1u, 15u}) {
        INFO("slots " << slots);
        Lists<Item> lists(device(), {9},
                          {.storage = Storage::fixed, .overflow = Overflow::stop, .slots = slots});
        Inserter inserter(lists);
        const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
        INFO(error.what());
        REQUIRE(contains(error.what(), std::to_string(slots) + " slots"));
        REQUIRE(contains(error.what(), "16 records"));
        REQUIRE(contains(error.what(), "raise slots"));
        REQUIRE(error.report().attempted == 145);
        REQUIRE(error.report().stored == 9 * slots);
        REQUIRE(error.report().dropped == 144 - 9 * slots);
        REQUIRE(error.report().rejected == 1);
        REQUIRE(error.report().passes == 1);
        REQUIRE(lists.capacity_nodes() == 9 * slots);
        require_sound(lists, 0);
        REQUIRE(lists.download().records().empty());

        Inserts<Item> fewer;
        for (cl_uint i = 0; i < 9 * slots; ++i) fewer.add(i % 9, {1.0f, i});
        require_complete(inserter.build(lists, fewer), 9 * slots);
        require_same(lists.download(), oracle_of(fewer, 9));
    }
}

TEST_CASE("each cell keeps as many records as it has slots") {
    CELLIST_RANDOM(random, 242u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    const Oracle<Item> oracle = oracle_of(inserts, 50);
    for (const std::uint32_t slots : {0u, 1u, 70u, 80u, 90u, 200u}) {
        INFO("slots " << slots);
        Lists<Item> lists(device(), {50},
                          {.storage = Storage::fixed, .overflow = Overflow::drop, .slots = slots});
        const BuildReport report = Inserter(lists).build(lists, inserts);
        const HostLists<Item> found = lists.download();
        std::uint64_t stored = 0;
        for (std::uint64_t cell = 0; cell < 50; ++cell) {
            const auto list = found.cell(cell);
            REQUIRE(list.size() == std::min<std::size_t>(slots, oracle.count(cell)));
            stored += list.size();
            std::vector<cl_uint> ids;
            for (const Item& item : list) {
                REQUIRE(inserts.cells[item.id] == cell);
                REQUIRE(inserts.records[item.id] == item);
                ids.push_back(item.id);
            }
            std::sort(ids.begin(), ids.end());
            REQUIRE(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
        }
        REQUIRE(report.stored == stored);
        REQUIRE(report.dropped == 4096 - stored);
        REQUIRE(report.attempted == 4096);
        REQUIRE(report.passes == 1);
        require_sound(lists, stored);
    }
}

TEST_CASE("the budget bounds how many slots there are") {
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 450; ++i) inserts.add(i % 45, {0.0f, i});
    const std::uint64_t exact =
        Lists<Item>(device(), {50}, {.storage = Storage::fixed, .slots = 10}).pool_bytes();
    Lists<Item> fits(device(), {50}, {.storage = Storage::fixed, .budget_bytes = exact});
    require_complete(Inserter(fits).build(fits, inserts), 450);
    REQUIRE(fits.pool_bytes() == exact);

    Lists<Item> lists(device(), {50}, {.storage = Storage::fixed, .budget_bytes = exact - 1});
    Inserter inserter(lists);
    const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
    INFO(error.what());
    REQUIRE(contains(error.what(), std::to_string(exact)));
    REQUIRE(contains(error.what(), std::to_string(exact - 1)));
    REQUIRE(error.report().attempted == 450);
    REQUIRE(lists.capacity_nodes() == 200);
    require_sound(lists, 0);
}

TEST_CASE("slots over the device's limit or the budget are refused") {
    const std::uint64_t limit =
        std::min<std::uint64_t>(device().info().max_allocation_bytes / sizeof(Item), 0xC0000000u);
    for (const std::uint64_t slots :
         {limit / 5 + 1, std::uint64_t{0xC0000001u}, std::uint64_t{0xFFFFFFFFu}}) {
        if (slots > 0xFFFFFFFFu) continue;
        INFO("slots " << slots);
        const auto error = error_of([&] {
            Lists<Item>(device(), {5},
                        {.storage = Storage::fixed, .slots = static_cast<std::uint32_t>(slots)});
        });
        INFO(error.what());
        REQUIRE(contains(error.what(), std::to_string(limit)));
    }
    const auto error = error_of([] {
        Lists<Item>(device(), {50}, {.storage = Storage::fixed, .slots = 10, .budget_bytes = 999});
    });
    REQUIRE(contains(error.what(), "999"));
}

}  // namespace
}  // namespace cellist::test
