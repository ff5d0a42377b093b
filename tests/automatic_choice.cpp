// What Storage::automatic chooses, from invented times. No device, no clock.
#include <iostream>

#include "chooser.hpp"
#include "support/errors.hpp"
#include "support/random.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

using detail::Chooser;
using detail::Cost;
using detail::Pattern;
using detail::Profile;

constexpr std::uint64_t records = 100'000;

/// Times of a storage: of a build and of a read.
struct Times {
    Cost linked, counted, fixed;
    [[nodiscard]] const Cost& of(Storage storage) const {
        return storage == Storage::linked ? linked : storage == Storage::counted ? counted : fixed;
    }
};

Chooser::Container container(const ListsOptions& options = {}, std::uint64_t cells = 10'000) {
    return {cells, 12, options};
}

/// Builds with these times to the end of the trial. Returns the storages that were built with, in
/// order.
std::vector<Storage> try_all(Chooser& chooser, const Times& times, std::uint64_t stored = records,
                             std::uint64_t longest = 20) {
    std::vector<Storage> tried;
    while (chooser.on_trial()) {
        REQUIRE(tried.size() < 12);
        tried.push_back(chooser.storage());
        chooser.measured({times.of(chooser.storage()), stored, longest});
    }
    return tried;
}

std::size_t count(const std::vector<Storage>& tried, Storage storage) {
    return static_cast<std::size_t>(std::count(tried.begin(), tried.end(), storage));
}

Profile profile_of(const Times& coherent, const Times& random, std::uint64_t of_records = records) {
    Profile profile(of_records);
    for (const Storage storage : all_storages) {
        profile.set_cost(storage, Pattern::coherent, coherent.of(storage));
        profile.set_cost(storage, Pattern::random, random.of(storage));
    }
    return profile;
}

TEST_CASE("the storage with the least time for a build and all reads is chosen") {
    CELLIST_RANDOM(random, 260u);
    int cases = 0;
    for (; cases < 1000; ++cases) {
        const auto time = [&] { return 1e-6 * (1 + below(random, 1000)); };
        const Times times{{time(), time()}, {time(), time()}, {time(), time()}};
        const std::uint32_t reads = below(random, 5);
        Chooser chooser(container({.expected_reads = reads}), {});
        const auto tried = try_all(chooser, times);
        const auto total = [&](Storage storage) {
            return times.of(storage).build_seconds + reads * times.of(storage).read_seconds;
        };
        INFO(chooser.reason());
        for (const Storage storage : all_storages) {
            REQUIRE(total(chooser.storage()) <= total(storage) * (1 + 1e-9));
            REQUIRE(count(tried, storage) >= 3);
        }
        // Once to warm up, and three times.
        REQUIRE(count(tried, chooser.storage()) == 4);
    }
    std::cout << "automatic: " << cases << " choices" << std::endl;
}

TEST_CASE("linked is first, and what is twice as slow is measured twice") {
    Chooser chooser(container(), {});
    REQUIRE(chooser.storage() == Storage::linked);
    REQUIRE(contains(chooser.reason(), "run cellist tune"));
    const auto tried = try_all(chooser, {{1e-3, 1e-3}, {3.5e-3, 1e-3}, {1e-3, 2e-3}});
    REQUIRE(count(tried, Storage::linked) == 4);
    REQUIRE(count(tried, Storage::counted) == 3);
    REQUIRE(count(tried, Storage::fixed) == 4);
    REQUIRE(chooser.storage() == Storage::linked);
}

TEST_CASE("a storage that is slow in its second build, too, can be chosen") {
    Chooser chooser(container(), {});
    int counted = 0;
    while (chooser.on_trial()) {
        double seconds = 1e-3;
        // Where it takes one pass from the second build on, that allocates and compiles.
        if (chooser.storage() == Storage::counted) seconds = ++counted <= 2 ? 1 : 0.5e-3;
        chooser.measured({{seconds, 1e-3}, records, 20});
    }
    REQUIRE(chooser.storage() == Storage::counted);
}

TEST_CASE("neither the first build nor a disturbed one counts") {
    Chooser chooser(container(), {});
    int builds = 0;
    std::optional<Storage> before;
    while (chooser.on_trial()) {
        const Storage storage = chooser.storage();
        builds = before == storage ? builds + 1 : 0;
        before = storage;
        // Linked is the best, and has the slowest first build and one that takes half as long again.
        double seconds = storage == Storage::linked ? 1e-3 : 1.1e-3;
        if (storage == Storage::linked && builds == 0) seconds = 1;
        if (storage == Storage::linked && builds == 2) seconds = 1.5e-3;
        chooser.measured({{seconds, 1e-3}, records, 20});
    }
    REQUIRE(chooser.storage() == Storage::linked);
}

TEST_CASE("builds of different numbers are compared by the record") {
    Chooser chooser(container(), {});
    std::uint64_t stored = records;
    while (chooser.on_trial()) {
        stored += records / 20;
        const double a_record = chooser.storage() == Storage::linked ? 1e-8 : 1.1e-8;
        chooser.measured({{a_record * static_cast<double>(stored), 0}, stored, 20});
    }
    REQUIRE(chooser.storage() == Storage::linked);
}

TEST_CASE("fixed is tried where its slots are at most four times the records, or few") {
    const Times best_fixed{{2e-3, 2e-3}, {2e-3, 2e-3}, {1e-3, 1e-3}};
    SECTION("short lists") {
        Chooser chooser(container(), {});
        try_all(chooser, best_fixed, records, 40);
        REQUIRE(chooser.storage() == Storage::fixed);
        const ListsOptions options = chooser.options(Storage::fixed);
        REQUIRE(options.slots == 40u);
        // Heads and four slots for each record, and not much more.
        REQUIRE(options.budget_bytes >= 40'000 + 12 * 4 * records);
        REQUIRE(options.budget_bytes <= 40'000 + 12 * 4 * records + 100'000);
    }
    SECTION("a long one") {
        Chooser chooser(container(), {});
        try_all(chooser, best_fixed, records, 41);
        REQUIRE(chooser.storage() != Storage::fixed);
        INFO(chooser.reason());
        REQUIRE(contains(chooser.reason(),
                         "fixed not tried: a longest list of 41 records would take 4.92 MB"));
    }
    SECTION("few slots, fewer records") {
        Chooser chooser(container({}, 64), {});
        try_all(chooser, best_fixed, 1100, 1024);
        REQUIRE(chooser.storage() == Storage::fixed);
    }
    SECTION("a list that was not walked to its end") {
        Chooser chooser(container({}, 1), {});
        try_all(chooser, best_fixed, 4'000'000, detail::walk_most);
        REQUIRE(chooser.storage() != Storage::fixed);
    }
    SECTION("the budget of the user is kept") {
        Chooser chooser(container({.budget_bytes = 1'000'000}), {});
        try_all(chooser, best_fixed);
        REQUIRE(chooser.options(Storage::fixed).budget_bytes == 1'000'000);
    }
}

TEST_CASE("where the pool may not grow, fixed needs slots that are no more than the capacity") {
    const Overflow overflow = GENERATE(Overflow::stop, Overflow::drop);
    const Times best_fixed{{2e-3, 2e-3}, {2e-3, 2e-3}, {1e-3, 1e-3}};
    ListsOptions options{.overflow = overflow, .capacity_nodes = 500'000};
    SECTION("none") {
        Chooser chooser(container(options), {});
        try_all(chooser, best_fixed);
        REQUIRE(chooser.storage() != Storage::fixed);
        REQUIRE(contains(chooser.reason(), "it needs slots"));
    }
    SECTION("too many") {
        options.slots = 51;
        Chooser chooser(container(options), {});
        try_all(chooser, best_fixed);
        REQUIRE(chooser.storage() != Storage::fixed);
        REQUIRE(contains(chooser.reason(), "more than capacity_nodes"));
    }
    SECTION("enough") {
        options.slots = 50;
        Chooser chooser(container(options), {});
        try_all(chooser, best_fixed);
        REQUIRE(chooser.storage() == Storage::fixed);
        for (const Storage storage : all_storages) {
            REQUIRE(chooser.options(storage).storage == storage);
            REQUIRE(chooser.options(storage).slots == 50u);
            REQUIRE(chooser.options(storage).capacity_nodes == 500'000u);
        }
    }
}

TEST_CASE("every storage has room for what was stored") {
    Chooser chooser(container({.capacity_nodes = 500}), {});
    REQUIRE(chooser.options(Storage::linked).capacity_nodes == 500u);
    chooser.measured({{1, 1}, 300, 20});
    REQUIRE(chooser.options(Storage::linked).capacity_nodes == 500u);
    chooser.measured({{1, 1}, 700, 30});
    chooser.measured({{1, 1}, 600, 20});
    REQUIRE(chooser.options(Storage::linked).capacity_nodes == 700u);
    REQUIRE(chooser.options(Storage::counted).capacity_nodes == 700u);
    REQUIRE(chooser.options(Storage::fixed).slots == 30u);
    chooser.expect(900);
    REQUIRE(chooser.options(Storage::linked).capacity_nodes == 900u);
}

TEST_CASE("an excluded storage is left, for ever or until the next trial") {
    const Times best_counted{{2e-3, 2e-3}, {1e-3, 1e-3}, {1.5e-3, 1.5e-3}};
    const Times best_fixed{{2e-3, 2e-3}, {1.5e-3, 1.5e-3}, {1e-3, 1e-3}};
    const auto another_trial = [](Chooser& chooser, const Times& times, std::uint64_t stored) {
        for (int i = 0; i < 64 && !chooser.on_trial(); ++i) chooser.built(stored);
        REQUIRE(chooser.on_trial());
        return try_all(chooser, times, stored, 20);
    };
    SECTION("in the trial, for ever") {
        Chooser chooser(container(), {});
        while (chooser.storage() == Storage::linked)
            chooser.measured({best_counted.linked, records, 20});
        REQUIRE(chooser.exclude(Storage::counted, "left: no", true) == Storage::linked);
        REQUIRE(chooser.storage() == Storage::fixed);
        try_all(chooser, best_counted);
        REQUIRE(chooser.storage() == Storage::fixed);
        REQUIRE(contains(chooser.reason(), "counted left: no"));
        REQUIRE(count(another_trial(chooser, best_counted, 3 * records), Storage::counted) == 0);
        REQUIRE(chooser.storage() == Storage::fixed);
    }
    SECTION("after it, until the next") {
        Chooser chooser(container(), {});
        try_all(chooser, best_fixed);
        REQUIRE(chooser.storage() == Storage::fixed);
        // The better one of those that always have room.
        REQUIRE(chooser.exclude(Storage::fixed, "left: too long") == Storage::counted);
        REQUIRE(chooser.storage() == Storage::counted);
        REQUIRE_FALSE(chooser.on_trial());
        REQUIRE(contains(chooser.reason(), "fixed left: too long"));
        another_trial(chooser, best_fixed, 3 * records);
        REQUIRE(chooser.storage() == Storage::fixed);
    }
    SECTION("the first storage, before anything is measured") {
        Chooser chooser(container(), {});
        REQUIRE(chooser.exclude(Storage::linked, "no") == Storage::counted);
        REQUIRE(chooser.storage() == Storage::counted);
        try_all(chooser, best_counted);
        REQUIRE(chooser.storage() == Storage::counted);
    }
    SECTION("all of them: the next build starts anew") {
        Chooser chooser(container(), {});
        REQUIRE(chooser.exclude(Storage::counted, "no", true) == Storage::linked);
        REQUIRE(chooser.exclude(Storage::linked, "no") == std::nullopt);
        REQUIRE(chooser.on_trial());
        REQUIRE(chooser.storage() == Storage::linked);
        try_all(chooser, best_counted);
        REQUIRE(chooser.storage() == Storage::fixed);
    }
}

TEST_CASE("another trial follows when the records have doubled or halved, and never many") {
    const Times times{{1e-3, 1e-3}, {2e-3, 1e-3}, {2e-3, 2e-3}};
    const auto builds_to_trial = [](Chooser& chooser, std::uint64_t stored) {
        int builds = 0;
        while (!chooser.on_trial() && builds < 1000) {
            chooser.built(stored);
            ++builds;
        }
        return builds;
    };
    for (const auto& [stored, expected] :
         std::vector<std::pair<std::uint64_t, bool>>{{records, false},
                                                     {2 * records, false},
                                                     {2 * records + 1, true},
                                                     {records / 2, false},
                                                     {records / 2 - 1, true},
                                                     {0, true}}) {
        INFO(stored << " records");
        Chooser chooser(container(), {});
        try_all(chooser, times);
        REQUIRE((builds_to_trial(chooser, stored) < 1000) == expected);
    }
    // Few records are like none.
    Chooser few(container(), {});
    try_all(few, times, 10);
    REQUIRE(builds_to_trial(few, 2000) == 1000);

    // Every frame another number.
    Chooser chooser(container(), {});
    int on_trial = 0;
    for (int build = 0; build < 10'000; ++build) {
        const std::uint64_t stored = build % 2 == 0 ? records : 10 * records;
        if (chooser.on_trial()) {
            chooser.measured({times.of(chooser.storage()), stored, 20});
            ++on_trial;
        } else {
            chooser.built(stored);
        }
    }
    REQUIRE(on_trial < 150);
}

TEST_CASE("builds without records teach nothing") {
    Chooser chooser(container(), {});
    for (int i = 0; i < 20; ++i) chooser.measured({{1e-3, 1e-3}, 0, 0});
    REQUIRE(chooser.storage() == Storage::linked);
    REQUIRE(try_all(chooser, {{2e-3, 1e-3}, {1e-3, 1e-3}, {3e-3, 3e-3}}).size() == 4 + 4 + 3);
    REQUIRE(chooser.storage() == Storage::counted);
}

TEST_CASE("a profile names the first storage") {
    const Times reads_matter{{1e-9, 50e-9}, {20e-9, 1e-9}, {1e-9, 1e-9}};
    const Profile profile = profile_of(reads_matter, reads_matter);
    for (const std::uint32_t reads : {0u, 1u, 10u}) {
        Chooser chooser(container({.expected_reads = reads}), profile);
        REQUIRE(chooser.storage() == (reads == 0 ? Storage::linked : Storage::counted));
        REQUIRE_FALSE(contains(chooser.reason(), "cellist tune"));
        REQUIRE(contains(chooser.reason(), "profile"));
    }
}

TEST_CASE("a storage that is hopeless by the profile is not tried, where the profile holds") {
    // A record of linked takes 2 to 4 ns, of counted at least 2.5 times as much.
    const Profile profile = profile_of({{1e-9, 1e-9}, {4e-9, 1e-9}, {1e-9, 1e-9}},
                                       {{2e-9, 2e-9}, {9e-9, 1e-9}, {2e-9, 2e-9}});
    const auto tried = [&](double a_record, std::uint64_t stored) {
        Chooser chooser(container(), profile);
        const double half = 0.5 * a_record * static_cast<double>(stored);
        const auto all = try_all(chooser, {{half, half}, {half, half}, {half, half}}, stored, 1);
        INFO(chooser.reason());
        REQUIRE(contains(chooser.reason(), "counted not tried") ==
                (count(all, Storage::counted) == 0));
        REQUIRE(count(all, Storage::fixed) > 0);
        return count(all, Storage::counted) > 0;
    };
    REQUIRE_FALSE(tried(3e-9, records));
    REQUIRE_FALSE(tried(1.5e-9, records));
    REQUIRE_FALSE(tried(5.5e-9, records));
    // Slower than the profile knows, or faster, or on fewer records.
    REQUIRE(tried(20e-9, records));
    REQUIRE(tried(0.5e-9, records));
    REQUIRE(tried(3e-9, records / 9));
}

TEST_CASE("the reason names the figures") {
    Chooser chooser(container({.expected_reads = 2}), {});
    try_all(chooser, {{4e-3, 0.4e-3}, {3.1e-3, 0.4e-3}, {9e-3, 1e-3}}, records, 900);
    INFO(chooser.reason());
    REQUIRE(chooser.reason() ==
            "counted: build 3.1 ms + 2 reads of 400 us = 3.9 ms for 100000 records; linked 4.8 ms; "
            "fixed not tried: a longest list of 900 records would take 108 MB");
}

}  // namespace
}  // namespace cellist::test
