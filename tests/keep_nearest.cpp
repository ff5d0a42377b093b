// SPDX-License-Identifier: MIT
// nearest() keeps exactly the records of each cell that come first, ties included, whatever
// the order of insertion.
#include <bit>

#include "support/errors.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Requires that each cell holds the first `slots` of its records by `rank`, in any order.
template <class T>
void require_first(const Lists<T>& lists, const Inserts<T>& inserts, std::uint32_t slots,
                   auto rank) {
    const HostLists<T> found = lists.download();
    const Oracle<T> oracle = oracle_of(inserts, lists.shape().cells());
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell) {
        std::vector<T> expected;
        const auto [begin, end] = oracle.equal_range(cell);
        for (auto entry = begin; entry != end; ++entry) expected.push_back(entry->second);
        std::sort(expected.begin(), expected.end(),
                  [&](const T& a, const T& b) { return rank(a) < rank(b); });
        expected.resize(std::min<std::size_t>(expected.size(), slots));
        if (sorted_bytes<T>(expected) != sorted_bytes<T>(found.cell(cell)))
            FAIL("cell " << cell << " keeps other records than the first " << slots);
    }
}

void require_report(const BuildReport& report, std::uint64_t attempted, std::uint64_t rejected,
                    std::uint64_t stored) {
    REQUIRE(report.attempted == attempted);
    REQUIRE(report.rejected == rejected);
    REQUIRE(report.stored == stored);
    REQUIRE(report.dropped == attempted - rejected - stored);
}

std::uint64_t kept(const Oracle<Item>& oracle, std::uint64_t cells, std::uint32_t slots) {
    std::uint64_t sum = 0;
    for (std::uint64_t cell = 0; cell < cells; ++cell)
        sum += std::min<std::uint64_t>(oracle.count(cell), slots);
    return sum;
}

constexpr auto by_members = [](const Item& item) { return members(item); };

TEST_CASE("the records that come first are kept, for every number of slots", "[oclgrind]") {
    CELLIST_RANDOM(random, 250u);
    Inserts<Item> inserts = random_inserts(500, 12, random);
    for (cl_uint i = 0; i < 7; ++i) inserts.add(12 + i, {-1000.0f, i});
    for (const std::uint32_t slots : {0u, 1u, 2u, 8u, 41u, 100u}) {
        INFO(slots << " slots");
        Lists<Item> lists(device(), {4, 3}, {.storage = nearest(&Item::key, slots)});
        const BuildReport report = Inserter(lists).build(lists, inserts);
        require_report(report, 507, 7, kept(oracle_of(inserts, 12), 12, slots));
        require_sound(lists, report.stored);
        require_first(lists, inserts, slots, by_members);
    }
}

TEST_CASE("hundreds of thousands of records are kept from in few passes") {
    CELLIST_RANDOM(random, 251u);
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 300'000; ++i)
        inserts.add(below(random, 1000), {std::bit_cast<cl_float>(below(random, 0x7F000000u)), i});
    Lists<Item> lists(device(), {1000}, {.storage = nearest(&Item::key, 16)});
    Inserter inserter(lists);
    for (int i = 0; i < 2; ++i) {
        const BuildReport report = inserter.build(lists, inserts);
        require_report(report, 300'000, 0, 16'000);
        REQUIRE(report.passes <= 4);
        require_first(lists, inserts, 16, by_members);
    }
    lists.sort(&Item::key);
    require_first(lists, inserts, 16, by_members);
}

TEST_CASE("ties are decided by the other members, the same in every order of insertion") {
    CELLIST_RANDOM(random, 252u);
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 3000; ++i)
        inserts.add(below(random, 7), {static_cast<cl_float>(below(random, 4)), i / 3});
    Lists<Item> lists(device(), {7}, {.storage = nearest(&Item::key, 10)});
    Inserter inserter(lists);
    std::vector<Item> first;
    for (int i = 0; i < 20; ++i) {
        inserts.shuffle(random);
        const BuildReport report = inserter.build(lists, inserts);
        require_report(report, 3000, 0, 70);
        REQUIRE(report.passes == 4);
        require_first(lists, inserts, 10, by_members);
        lists.sort(&Item::key);
        const std::vector<Item> records = lists.download().records();
        if (i == 0) first = records;
        REQUIRE(records == first);
    }
}

TEST_CASE("ties that take more than the budget end a build, and leave the lists usable") {
    ListsOptions options{.storage = nearest(&Item::key, 10)};
    options.budget_bytes = Lists<Item>(device(), {7}, options).pool_bytes();
    Lists<Item> lists(device(), {7}, options);
    Inserts<Item> ties, others;
    for (cl_uint i = 0; i < 300; ++i) {
        ties.add(i % 7, {1.0f, i});
        others.add(i % 7, {static_cast<cl_float>(i), i});
    }
    Inserter inserter(lists);
    require_report(inserter.build(lists, others), 300, 0, 70);
    const auto error = error_of([&] { inserter.build(lists, ties); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "budget"));
    REQUIRE(lists.lengths().total == 0);
    require_report(inserter.build(lists, others), 300, 0, 70);
    require_first(lists, others, 10, by_members);
}

TEST_CASE("records that are the same in every member are kept as often as there is room") {
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 1000; ++i) inserts.add(i % 3, {2.5f, 7});
    Lists<Item> lists(device(), {3}, {.storage = nearest(&Item::key, 5)});
    const BuildReport report = Inserter(lists).build(lists, inserts);
    require_report(report, 1000, 0, 15);
    require_first(lists, inserts, 5, by_members);
}

TEST_CASE("no option but the budget changes what keeps the nearest") {
    CELLIST_RANDOM(random, 253u);
    const Inserts<Item> inserts = random_inserts(500, 5, random);
    for (const Overflow overflow : {Overflow::grow, Overflow::stop, Overflow::drop}) {
        Lists<Item> lists(device(), {5},
                          {.storage = nearest(&Item::key, 4),
                           .overflow = overflow,
                           .capacity_nodes = 3,
                           .slots = 1});
        REQUIRE(lists.storage() == Storage::fixed);
        require_report(Inserter(lists).build(lists, inserts), 500, 0, 20);
        require_sound(lists, 20);
        require_first(lists, inserts, 4, by_members);
    }
}

struct Depth {
    cl_float value;
};
CELLIST_STRUCT(Depth, value);

TEST_CASE("a member of another record cannot keep the nearest") {
    const auto error =
        error_of([] { Lists<Item>(device(), {5}, {.storage = nearest(&Depth::value, 4)}); });
    REQUIRE(contains(error.what(), "Depth"));
    REQUIRE(contains(error.what(), "Item"));
}

TEST_CASE("a build that keeps the nearest is started without blocking, and beside others") {
    CELLIST_RANDOM(random, 255u);
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 3000; ++i)
        inserts.add(below(random, 7), {static_cast<cl_float>(below(random, 4)), i});
    Lists<Item> few(device(), {7}, {.storage = nearest(&Item::key, 10)});
    const Storage other = GENERATE(from_range(all_storages));
    Lists<Item> all(device(), {7}, {.storage = other, .capacity_nodes = 10});
    Kernel kernel(device(), insert_source("Item"), "insert_all", few);
    const Buffer<cl_uint> cells(device(), inserts.cells);
    const Buffer<Item> records(device(), inserts.records);
    auto pending = build_async(
        [&] {
            kernel.run(3000, few, cells, records, cl_uint{3000});
            kernel.run(3000, all, cells, records, cl_uint{3000});
        },
        few, all);
    few.sort(&Item::key);
    require_first(few, inserts, 10, by_members);
    const auto [report_few, report_all] = pending.get();
    require_report(report_few, 3000, 0, 70);
    require_complete(report_all, 3000);
    require_same(all.download(), oracle_of(inserts, 7));
    require_sound(few, 70);
}

TEST_CASE("a shape without cells keeps nothing") {
    CELLIST_RANDOM(random, 256u);
    Lists<Item> lists(device(), {0}, {.storage = nearest(&Item::key, 4)});
    require_report(Inserter(lists).build(lists, random_inserts(144, 50, random)), 144, 144, 0);
}

}  // namespace
}  // namespace cellist::test
