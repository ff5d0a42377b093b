// SPDX-License-Identifier: MIT
// append_async() does not wait for the device under drop, and finishes an append later otherwise.
#include <memory>

#include "support/appends.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("what reads lists of a pending append finds all records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 420u);
    for (const Overflow overflow : {Overflow::grow, Overflow::drop}) {
        for (const std::uint64_t capacity : {900u, 5000u}) {
            if (overflow == Overflow::drop && capacity == 900) continue;
            INFO("capacity " << capacity);
            Lists<Item> lists(device(), {50},
                              {.storage = storage,
                               .overflow = overflow,
                               .capacity_nodes = capacity,
                               .slots = overflow == Overflow::drop ? 500u : 18u});
            const Inserts<Item> first = random_inserts(900, 50, random);
            const Inserts<Item> second = random_inserts(300, 50, random);
            UploadedInserts a(lists, first);
            UploadedInserts b(lists, second);
            Oracle<Item> oracle = oracle_of(first, 50);
            oracle.merge(oracle_of(second, 50));

            auto built = a.build_async(lists);
            auto appended = lists.append_async(b.kernel, Range::padded(b.count, 64), b.cells,
                                               b.records, b.count);
            require_same(lists.download(), oracle);
            require_complete(built.get(), 900);
            const BuildReport report = appended.get();
            REQUIRE(report.existing == 900);
            REQUIRE(report.attempted == 300);
            REQUIRE(report.stored == 1200);
            require_sound(lists, 1200);

            auto again = lists.append_async([&] { b.insert(lists); });
            auto last = lists.append_async([&] { a.insert(lists); });
            REQUIRE(last.get().existing == 1500);
            REQUIRE(again.get().stored == 1500);
            require_sound(lists, 2400);
        }
    }
}

TEST_CASE("lists may go before a pending append is finished") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 421u);
    const Inserts<Item> inserts = random_inserts(900, 50, random);
    Pending<BuildReport> pending;
    std::unique_ptr<UploadedInserts> uploaded;
    {
        Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 900});
        uploaded = std::make_unique<UploadedInserts>(lists, inserts);
        uploaded->build_async(lists).get();
        pending = lists.append_async(uploaded->kernel, Range::padded(uploaded->count, 64),
                                     uploaded->cells, uploaded->records, uploaded->count);
        (void)lists.append_async(uploaded->kernel, Range::padded(uploaded->count, 64),
                                 uploaded->cells, uploaded->records, uploaded->count);
    }
    REQUIRE(pending.get().stored == 1800);
}

TEST_CASE("a pending append that fails leaves the existing records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 422u);
    Lists<Item> lists(
        device(), {50},
        {.storage = storage, .overflow = Overflow::stop, .capacity_nodes = 1000, .slots = 20});
    Inserts<Item> first;
    for (cl_uint i = 0; i < 900; ++i) first.add(i % 50, {1.0f, i});
    UploadedInserts uploaded(lists, first);
    (void)uploaded.build_async(lists).get();
    auto pending = lists.append_async([&] { uploaded.insert(lists); });
    REQUIRE_THROWS_AS(lists.lengths(), OverflowError);
    require_sound(lists, 900);
    require_same(lists.download(), oracle_of(first, 50));
    REQUIRE_THROWS_AS(pending.get(), OverflowError);
    require_sound(lists, 900);
}

}  // namespace
}  // namespace cellist::test
