// SPDX-License-Identifier: MIT
// What a container starts with where its options say nothing, for each storage, and which options
// go together.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("linked is the default, and starts with a node for each cell, at least 65,536") {
    REQUIRE(ListsOptions{}.storage == Storage::linked);
    REQUIRE(ListsOptions{}.overflow == Overflow::grow);
    REQUIRE(Lists<Item>(device(), {10}).capacity_nodes() == 65'536);
    REQUIRE(Lists<Item>(device(), {100'000}).capacity_nodes() == 100'000);
}

TEST_CASE("counted starts without nodes") {
    REQUIRE(Lists<Item>(device(), {10}, {.storage = Storage::counted}).capacity_nodes() == 0);
}

TEST_CASE("fixed starts with four slots for each cell, and has no use for capacity_nodes") {
    REQUIRE(Lists<Item>(device(), {10}, {.storage = Storage::fixed}).capacity_nodes() == 40);
    REQUIRE(Lists<Item>(device(), {10}, {.storage = Storage::fixed, .capacity_nodes = 1000})
                .capacity_nodes() == 40);
    REQUIRE(Lists<Item>(device(), {0}, {.storage = Storage::fixed}).capacity_nodes() == 0);
}

TEST_CASE("the memory of a container is its heads, its nodes and its counters") {
    // Words of each cell, and bytes of a node, its link included.
    const auto [storage, cell_words, node_bytes] =
        GENERATE(table<Storage, std::uint64_t, std::uint64_t>(
            {{Storage::linked, 1, 12}, {Storage::counted, 2, 8}, {Storage::fixed, 1, 8 * 100}}));
    INFO(name_of(storage));
    const auto bytes = [&, storage = storage](std::uint64_t cells, std::uint32_t room) {
        return Lists<Item>(device(), {cells},
                           {.storage = storage, .capacity_nodes = room, .slots = room})
            .pool_bytes();
    };
    const std::uint64_t counters = bytes(0, 0);
    REQUIRE(counters <= 257 * 64 + (storage == Storage::counted ? 4 : 0));
    REQUIRE(bytes(100, 7) == counters + 100 * 4 * cell_words + 7 * node_bytes);
}

TEST_CASE("a storage that does not exist is refused") {
    REQUIRE_THROWS_AS(Lists<Item>(device(), {5}, {.storage = static_cast<Storage>(7)}), Error);
}

// ---- options together --------------------------------------------------------------------------

/// What comes of options where each of 10 cells gets 14 records.
struct Together {
    const char* what;
    ListsOptions options;
    std::uint64_t stored;  ///< 0 where the build throws OverflowError
};

const std::vector<Together> together{
    {"slots, linked", {.storage = Storage::linked, .slots = 1}, 140},
    {"slots, counted", {.storage = Storage::counted, .slots = 1}, 140},
    {"no slots, linked", {.storage = Storage::linked, .slots = 0}, 140},
    {"slots and drop, linked",
     {.storage = Storage::linked, .overflow = Overflow::drop, .capacity_nodes = 140, .slots = 1},
     140},
    {"slots and stop, counted",
     {.storage = Storage::counted, .overflow = Overflow::stop, .capacity_nodes = 139, .slots = 14},
     0},
    {"capacity and drop, fixed",
     {.storage = Storage::fixed, .overflow = Overflow::drop, .capacity_nodes = 5, .slots = 3},
     30},
    {"capacity and stop, fixed",
     {.storage = Storage::fixed, .overflow = Overflow::stop, .capacity_nodes = 140, .slots = 13},
     0},
    {"nearest, stop and capacity",
     {.storage = nearest(&Item::key, 3), .overflow = Overflow::stop, .capacity_nodes = 5},
     30},
    {"slots, automatic", {.storage = Storage::automatic, .slots = 1}, 140},
    {"slots and drop, automatic",
     {.storage = Storage::automatic, .overflow = Overflow::drop, .capacity_nodes = 100, .slots = 3},
     100},
    {"reads, linked", {.storage = Storage::linked, .expected_reads = 5}, 140},
    {"reads, counted", {.storage = Storage::counted, .expected_reads = 0}, 140},
    {"reads, fixed", {.storage = Storage::fixed, .expected_reads = 0xFFFFFFFF}, 140},
    {"no reads, automatic", {.storage = Storage::automatic, .expected_reads = 0}, 140},
    {"many reads, automatic", {.storage = Storage::automatic, .expected_reads = 0xFFFFFFFF}, 140},
};

/// Calls `build(lists, insert)`, and requires what the table says of its report.
void require_outcome(const Together& row, auto build) {
    INFO(row.what);
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 140; ++i) inserts.add(i % 10, {static_cast<cl_float>(i), i});
    Lists<Item> lists(device(), {10}, row.options);
    Inserter inserter(lists);
    const auto insert = [&] { inserter.run(lists, inserts); };
    if (row.stored == 0) {
        REQUIRE(error_of<OverflowError>([&] { build(lists, insert); }).report().attempted == 140);
    } else {
        const BuildReport report = build(lists, insert);
        REQUIRE(report.attempted == 140);
        REQUIRE(report.stored == row.stored);
        REQUIRE(report.dropped == 140 - row.stored);
    }
}

TEST_CASE("options that a storage has no use for change nothing") {
    for (const Together& row : together) {
        require_outcome(row, [&](Lists<Item>& lists, auto insert) {
            const BuildReport report = lists.build(insert);
            require_sound(lists, row.stored);
            return report;
        });
        require_outcome(
            row, [&](Lists<Item>& lists, auto insert) { return build(insert, lists).front(); });
    }
}

TEST_CASE("slices take any options") {
    for (Together row : together) {
        // What is too much for a pool fits into several slices; a list that is too long for slots
        // does not.
        if (row.options.storage != Storage::fixed) row.stored = 140;
        require_outcome(row, [&](Lists<Item>& lists, auto insert) {
            std::uint64_t read = 0;
            const BuildReport report =
                lists.build_slices(insert, [&](const Slice&) { read += lists.lengths().total; });
            REQUIRE(read == row.stored);
            require_sound(lists, 0);
            return report;
        });
    }
}

TEST_CASE("options that contradict each other are refused, and what is missing is named") {
    const auto refuse = [](const ListsOptions& options, const std::string& named) {
        const auto error = error_of([&] { Lists<Item>(device(), {10}, options); });
        INFO(error.what());
        REQUIRE(std::string(error.what()) == named);
    };
    for (const Storage storage : {Storage::linked, Storage::counted, Storage::automatic}) {
        INFO("storage " << name_of(storage));
        for (const Overflow overflow : {Overflow::stop, Overflow::drop})
            refuse({.storage = storage, .overflow = overflow, .slots = 4},
                   "an Overflow other than grow needs capacity_nodes");
    }
    for (const Overflow overflow : {Overflow::stop, Overflow::drop})
        refuse({.storage = Storage::fixed, .overflow = overflow, .capacity_nodes = 100},
               "an Overflow other than grow needs slots in Storage::fixed");
}

TEST_CASE("heads over the budget are refused in every storage") {
    CELLIST_EACH_STORAGE(storage);
    const auto error = error_of([&] {
        Lists<Item>(device(), {1000}, {.storage = storage, .slots = 0, .budget_bytes = 3999});
    });
    INFO(error.what());
    REQUIRE(contains(error.what(), "3999"));
    REQUIRE(contains(error.what(), "1000"));
}

}  // namespace
}  // namespace cellist::test
