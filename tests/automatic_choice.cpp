// SPDX-License-Identifier: MIT
// What Storage::automatic chooses, from invented times. No device, no clock.
#include <iostream>

#include "support/errors.hpp"
#include "support/random.hpp"
#include "support/storages.hpp"
#include "tune/storage_tuner.hpp"

namespace cellist::test {
namespace {

using detail::Cost;
using detail::Pattern;
using detail::Profile;
using detail::StorageTuner;

constexpr std::uint64_t profile_records = 100'000;

/// Times of a storage: of a build and of a read.
struct Times {
    Cost linked, counted, fixed;
    [[nodiscard]] const Cost& of(Storage storage) const {
        return storage == Storage::linked ? linked : storage == Storage::counted ? counted : fixed;
    }
};

StorageTuner::Container container(const ListsOptions& options = {}, std::uint64_t cells = 10'000) {
    return {cells, 12, options};
}

/// Builds with these times to the end of the trial. Returns the storages that were built with, in
/// order.
std::vector<Storage> try_all(StorageTuner& tuner, const Times& times,
                             std::uint64_t stored = profile_records, std::uint64_t longest = 20) {
    std::vector<Storage> tried;
    while (tuner.on_trial()) {
        REQUIRE(tried.size() < 12);
        tried.push_back(tuner.storage());
        tuner.measured({times.of(tuner.storage()), stored, longest});
    }
    return tried;
}

std::size_t count(const std::vector<Storage>& tried, Storage storage) {
    return static_cast<std::size_t>(std::count(tried.begin(), tried.end(), storage));
}

Profile profile_of(const Times& coherent, const Times& random,
                   std::uint64_t of_records = profile_records) {
    Profile profile(of_records);
    for (const Storage storage : detail::choices) {
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
        StorageTuner tuner(container({.expected_reads = reads}), {});
        const auto tried = try_all(tuner, times);
        const auto total = [&](Storage storage) {
            return times.of(storage).build_seconds + reads * times.of(storage).read_seconds;
        };
        INFO(tuner.reason());
        for (const Storage storage : detail::choices) {
            REQUIRE(total(tuner.storage()) <= total(storage) * (1 + 1e-9));
            REQUIRE(count(tried, storage) >= 3);
        }
        // Once to warm up, and three times.
        REQUIRE(count(tried, tuner.storage()) == 4);
    }
    std::cout << "automatic: " << cases << " choices" << std::endl;
}

TEST_CASE("linked is first, and what is twice as slow is measured twice") {
    StorageTuner tuner(container(), {});
    REQUIRE(tuner.storage() == Storage::linked);
    REQUIRE(contains(tuner.reason(), "run cellist tune"));
    const auto tried = try_all(tuner, {{1e-3, 1e-3}, {3.5e-3, 1e-3}, {1e-3, 2e-3}});
    REQUIRE(count(tried, Storage::linked) == 4);
    REQUIRE(count(tried, Storage::counted) == 3);
    REQUIRE(count(tried, Storage::fixed) == 4);
    REQUIRE(tuner.storage() == Storage::linked);
}

TEST_CASE("a storage that is slow in its second build, too, can be chosen") {
    StorageTuner tuner(container(), {});
    int counted = 0;
    while (tuner.on_trial()) {
        double seconds = 1e-3;
        // Where it takes one pass from the second build on, that allocates and compiles.
        if (tuner.storage() == Storage::counted) seconds = ++counted <= 2 ? 1 : 0.5e-3;
        tuner.measured({{seconds, 1e-3}, profile_records, 20});
    }
    REQUIRE(tuner.storage() == Storage::counted);
}

TEST_CASE("neither the first build nor a disturbed one counts") {
    StorageTuner tuner(container(), {});
    int builds = 0;
    std::optional<Storage> before;
    while (tuner.on_trial()) {
        const Storage storage = tuner.storage();
        builds = before == storage ? builds + 1 : 0;
        before = storage;
        // Linked is the best, and has the slowest first build and one that takes half as long
        // again.
        double seconds = storage == Storage::linked ? 1e-3 : 1.1e-3;
        if (storage == Storage::linked && builds == 0) seconds = 1;
        if (storage == Storage::linked && builds == 2) seconds = 1.5e-3;
        tuner.measured({{seconds, 1e-3}, profile_records, 20});
    }
    REQUIRE(tuner.storage() == Storage::linked);
}

TEST_CASE("builds of different numbers are compared by the record") {
    StorageTuner tuner(container(), {});
    std::uint64_t stored = profile_records;
    while (tuner.on_trial()) {
        stored += profile_records / 20;
        const double a_record = tuner.storage() == Storage::linked ? 1e-8 : 1.1e-8;
        tuner.measured({{a_record * static_cast<double>(stored), 0}, stored, 20});
    }
    REQUIRE(tuner.storage() == Storage::linked);
}

TEST_CASE("fixed is tried where its slots are at most four times the records, or few") {
    const Times best_fixed{{2e-3, 2e-3}, {2e-3, 2e-3}, {1e-3, 1e-3}};
    SECTION("short lists") {
        StorageTuner tuner(container(), {});
        try_all(tuner, best_fixed, profile_records, 40);
        REQUIRE(tuner.storage() == Storage::fixed);
        const ListsOptions options = tuner.options(Storage::fixed);
        REQUIRE(options.slots == 40u);
        // Heads and four slots for each record, and not much more.
        REQUIRE(options.budget_bytes >= 40'000 + 12 * 4 * profile_records);
        REQUIRE(options.budget_bytes <= 40'000 + 12 * 4 * profile_records + 100'000);
    }
    SECTION("a long one") {
        StorageTuner tuner(container(), {});
        try_all(tuner, best_fixed, profile_records, 41);
        REQUIRE(tuner.storage() != Storage::fixed);
        INFO(tuner.reason());
        REQUIRE(contains(tuner.reason(),
                         "fixed not tried: a longest list of 41 records would take 4.92 MB"));
    }
    SECTION("few slots, fewer records") {
        StorageTuner tuner(container({}, 64), {});
        try_all(tuner, best_fixed, 1100, 1024);
        REQUIRE(tuner.storage() == Storage::fixed);
    }
    SECTION("a list that was not walked to its end") {
        StorageTuner tuner(container({}, 1), {});
        try_all(tuner, best_fixed, 4'000'000, detail::traverse_most);
        REQUIRE(tuner.storage() != Storage::fixed);
    }
    SECTION("the budget of the user is kept") {
        StorageTuner tuner(container({.budget_bytes = 1'000'000}), {});
        try_all(tuner, best_fixed);
        REQUIRE(tuner.options(Storage::fixed).budget_bytes == 1'000'000);
    }
}

TEST_CASE("where the pool may not grow, fixed needs slots that are no more than the capacity") {
    const Overflow overflow = GENERATE(Overflow::stop, Overflow::drop);
    const Times best_fixed{{2e-3, 2e-3}, {2e-3, 2e-3}, {1e-3, 1e-3}};
    ListsOptions options{.overflow = overflow, .capacity_nodes = 500'000};
    SECTION("none") {
        StorageTuner tuner(container(options), {});
        try_all(tuner, best_fixed);
        REQUIRE(tuner.storage() != Storage::fixed);
        REQUIRE(contains(tuner.reason(), "it needs slots"));
    }
    SECTION("too many") {
        options.slots = 51;
        StorageTuner tuner(container(options), {});
        try_all(tuner, best_fixed);
        REQUIRE(tuner.storage() != Storage::fixed);
        REQUIRE(contains(tuner.reason(), "more than capacity_nodes"));
    }
    SECTION("enough") {
        options.slots = 50;
        StorageTuner tuner(container(options), {});
        try_all(tuner, best_fixed);
        REQUIRE(tuner.storage() == Storage::fixed);
        for (const Storage storage : detail::choices) {
            REQUIRE(tuner.options(storage).storage == storage);
            REQUIRE(tuner.options(storage).slots == 50u);
            REQUIRE(tuner.options(storage).capacity_nodes == 500'000u);
        }
    }
}

TEST_CASE("every storage has room for what was stored") {
    StorageTuner tuner(container({.capacity_nodes = 500}), {});
    REQUIRE(tuner.options(Storage::linked).capacity_nodes == 500u);
    tuner.measured({{1, 1}, 300, 20});
    REQUIRE(tuner.options(Storage::linked).capacity_nodes == 500u);
    tuner.measured({{1, 1}, 700, 30});
    tuner.measured({{1, 1}, 600, 20});
    REQUIRE(tuner.options(Storage::linked).capacity_nodes == 700u);
    REQUIRE(tuner.options(Storage::counted).capacity_nodes == 700u);
    REQUIRE(tuner.options(Storage::fixed).slots == 30u);
    tuner.expect(900);
    REQUIRE(tuner.options(Storage::linked).capacity_nodes == 900u);
}

TEST_CASE("an excluded storage is left, for ever or until the next trial") {
    const Times best_counted{{2e-3, 2e-3}, {1e-3, 1e-3}, {1.5e-3, 1.5e-3}};
    const Times best_fixed{{2e-3, 2e-3}, {1.5e-3, 1.5e-3}, {1e-3, 1e-3}};
    const auto another_trial = [](StorageTuner& tuner, const Times& times, std::uint64_t stored) {
        for (int i = 0; i < 64 && !tuner.on_trial(); ++i) tuner.built(stored);
        REQUIRE(tuner.on_trial());
        return try_all(tuner, times, stored, 20);
    };
    SECTION("in the trial, for ever") {
        StorageTuner tuner(container(), {});
        while (tuner.storage() == Storage::linked)
            tuner.measured({best_counted.linked, profile_records, 20});
        REQUIRE(tuner.exclude(Storage::counted, "left: no", StorageTuner::Exclusion::permanent) ==
                Storage::linked);
        REQUIRE(tuner.storage() == Storage::fixed);
        try_all(tuner, best_counted);
        REQUIRE(tuner.storage() == Storage::fixed);
        REQUIRE(contains(tuner.reason(), "counted left: no"));
        REQUIRE(count(another_trial(tuner, best_counted, 3 * profile_records), Storage::counted) ==
                0);
        REQUIRE(tuner.storage() == Storage::fixed);
    }
    SECTION("after it, until the next") {
        StorageTuner tuner(container(), {});
        try_all(tuner, best_fixed);
        REQUIRE(tuner.storage() == Storage::fixed);
        // The better one of those that always have room.
        REQUIRE(tuner.exclude(Storage::fixed, "left: too long") == Storage::counted);
        REQUIRE(tuner.storage() == Storage::counted);
        REQUIRE_FALSE(tuner.on_trial());
        REQUIRE(contains(tuner.reason(), "fixed left: too long"));
        another_trial(tuner, best_fixed, 3 * profile_records);
        REQUIRE(tuner.storage() == Storage::fixed);
    }
    SECTION("the first storage, before anything is measured") {
        StorageTuner tuner(container(), {});
        REQUIRE(tuner.exclude(Storage::linked, "no") == Storage::counted);
        REQUIRE(tuner.storage() == Storage::counted);
        try_all(tuner, best_counted);
        REQUIRE(tuner.storage() == Storage::counted);
    }
    SECTION("all of them: the next build starts anew") {
        StorageTuner tuner(container(), {});
        REQUIRE(tuner.exclude(Storage::counted, "no", StorageTuner::Exclusion::permanent) ==
                Storage::linked);
        REQUIRE(tuner.exclude(Storage::linked, "no") == std::nullopt);
        REQUIRE(tuner.on_trial());
        REQUIRE(tuner.storage() == Storage::linked);
        try_all(tuner, best_counted);
        REQUIRE(tuner.storage() == Storage::fixed);
    }
}

TEST_CASE("another trial follows when the records have doubled or halved, and never many") {
    const Times times{{1e-3, 1e-3}, {2e-3, 1e-3}, {2e-3, 2e-3}};
    const auto builds_to_trial = [](StorageTuner& tuner, std::uint64_t stored) {
        int builds = 0;
        while (!tuner.on_trial() && builds < 1000) {
            tuner.built(stored);
            ++builds;
        }
        return builds;
    };
    for (const auto& [stored, expected] :
         std::vector<std::pair<std::uint64_t, bool>>{{profile_records, false},
                                                     {2 * profile_records, false},
                                                     {2 * profile_records + 1, true},
                                                     {profile_records / 2, false},
                                                     {profile_records / 2 - 1, true},
                                                     {0, true}}) {
        INFO(stored << " records");
        StorageTuner tuner(container(), {});
        try_all(tuner, times);
        REQUIRE((builds_to_trial(tuner, stored) < 1000) == expected);
    }
    // Few records are like none.
    StorageTuner few(container(), {});
    try_all(few, times, 10);
    REQUIRE(builds_to_trial(few, 2000) == 1000);

    // Every frame another number.
    StorageTuner tuner(container(), {});
    int on_trial = 0;
    for (int build = 0; build < 10'000; ++build) {
        const std::uint64_t stored = build % 2 == 0 ? profile_records : 10 * profile_records;
        if (tuner.on_trial()) {
            tuner.measured({times.of(tuner.storage()), stored, 20});
            ++on_trial;
        } else {
            tuner.built(stored);
        }
    }
    REQUIRE(on_trial < 150);
}

TEST_CASE("builds without records teach nothing") {
    StorageTuner tuner(container(), {});
    for (int i = 0; i < 20; ++i) tuner.measured({{1e-3, 1e-3}, 0, 0});
    REQUIRE(tuner.storage() == Storage::linked);
    REQUIRE(try_all(tuner, {{2e-3, 1e-3}, {1e-3, 1e-3}, {3e-3, 3e-3}}).size() == 4 + 4 + 3);
    REQUIRE(tuner.storage() == Storage::counted);
}

TEST_CASE("a profile names the first storage") {
    const Times reads_matter{{1e-9, 50e-9}, {20e-9, 1e-9}, {1e-9, 1e-9}};
    const Profile profile = profile_of(reads_matter, reads_matter);
    for (const std::uint32_t reads : {0u, 1u, 10u}) {
        StorageTuner tuner(container({.expected_reads = reads}), profile);
        REQUIRE(tuner.storage() == (reads == 0 ? Storage::linked : Storage::counted));
        REQUIRE_FALSE(contains(tuner.reason(), "cellist tune"));
        REQUIRE(contains(tuner.reason(), "profile"));
    }
}

TEST_CASE("a storage that is hopeless by the profile is not tried, where the profile holds") {
    // A record of linked takes 2 to 4 ns, of counted at least 2.5 times as much.
    const Profile profile = profile_of({{1e-9, 1e-9}, {4e-9, 1e-9}, {1e-9, 1e-9}},
                                       {{2e-9, 2e-9}, {9e-9, 1e-9}, {2e-9, 2e-9}});
    const auto tried = [&](double a_record, std::uint64_t stored) {
        StorageTuner tuner(container(), profile);
        const double half = 0.5 * a_record * static_cast<double>(stored);
        const auto all = try_all(tuner, {{half, half}, {half, half}, {half, half}}, stored, 1);
        INFO(tuner.reason());
        REQUIRE(contains(tuner.reason(), "counted not tried") ==
                (count(all, Storage::counted) == 0));
        REQUIRE(count(all, Storage::fixed) > 0);
        return count(all, Storage::counted) > 0;
    };
    REQUIRE_FALSE(tried(3e-9, profile_records));
    REQUIRE_FALSE(tried(1.5e-9, profile_records));
    REQUIRE_FALSE(tried(5.5e-9, profile_records));
    // Slower than the profile knows, or faster, or on fewer records.
    REQUIRE(tried(20e-9, profile_records));
    REQUIRE(tried(0.5e-9, profile_records));
    REQUIRE(tried(3e-9, profile_records / 9));
}

TEST_CASE("the reason names the figures") {
    StorageTuner tuner(container({.expected_reads = 2}), {});
    try_all(tuner, {{4e-3, 0.4e-3}, {3.1e-3, 0.4e-3}, {9e-3, 1e-3}}, profile_records, 900);
    INFO(tuner.reason());
    REQUIRE(tuner.reason() ==
            "counted: build 3.1 ms + 2 reads of 400 us = 3.9 ms for 100000 records; linked 4.8 ms; "
            "fixed not tried: a longest list of 900 records would take 108 MB");
}

}  // namespace
}  // namespace cellist::test
