// SPDX-License-Identifier: MIT
// The counts of cells in Storage::counted and Storage::fixed stay exact near 2^31 and in sums over
// 2^32, and no count wraps into a node.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr cl_uint count_max = 0x80000000u;

/// The presets stand in for billions of inserts into the first cells.
constexpr auto preset_cell_source = R"(
#include <cellist/lists.clh>

// As if `count` records had been inserted into a cell already, the dropped ones among them counted.
kernel void preset(CELLIST_LISTS(Item, lists), uint cell, uint count)
{
    const cellist_view lists_view = cellist_view_of(lists);
    uint room = 0, at = cell;
    if (lists_view.mode == CELLIST_FIXED) room = lists_view.slots;
    else at += lists_view.cells + 1;
    if (lists_view.mode == CELLIST_CONTIGUOUS) room = lists_heads[cell + 1] - lists_heads[cell];
    lists_heads[at] = count;
    if (lists_view.mode == CELLIST_COUNTING || count <= room) return;
    const uint before = lists_shards[0].dropped_low;
    lists_shards[0].dropped_low = before + (count - room);
    if (before + (count - room) < before) ++lists_shards[0].dropped_high;
}

kernel void insert_many(CELLIST_LISTS(Item, lists), uint cell, volatile global uint* inserted)
{
    Item item = { 0.0f, get_global_id(0) };
    if (cellist_insert(lists, cell, item)) atomic_inc(inserted);
}

kernel void read_count(CELLIST_LISTS(Item, lists), uint cell, global uint* count)
{
    const cellist_view lists_view = cellist_view_of(lists);
    *count = lists_heads[lists_view.mode == CELLIST_FIXED ? cell : lists_view.cells + 1 + cell];
}
)";

constexpr cl_uint many_inserts = 4992;

struct Presets {
    explicit Presets(const Lists<Item>& lists)
        : preset(device(), preset_cell_source, "preset", lists),
          insert(device(), preset_cell_source, "insert_many", lists),
          read(device(), preset_cell_source, "read_count", lists) {
        inserted.fill(0);
    }
    cl_uint count_of(const Lists<Item>& lists, cl_uint cell) {
        const Buffer<cl_uint> count(device(), 1);
        read.run(1, lists, cell, count);
        return count.download()[0];
    }

    Kernel preset;
    Kernel insert;
    Kernel read;
    Buffer<cl_uint> inserted{device(), 1};
};

TEST_CASE("a slot count near 2^31 hands out no slot and does not pass 2^31", "[accounting]") {
    for (const cl_uint count : {8u, 0x7FFFFFFFu - many_inserts, 0x7FFFFFF0u, 0x7FFFFFFFu, count_max,
                                count_max + 100'000u}) {
        INFO("count " << count);
        Lists<Item> lists(device(), {50},
                          {.storage = Storage::fixed, .overflow = Overflow::drop, .slots = 8});
        Presets presets(lists);
        const BuildReport report = lists.build([&] {
            presets.preset.run(1, lists, cl_uint{3}, count);
            presets.insert.run(many_inserts, lists, cl_uint{3}, presets.inserted);
        });
        REQUIRE(presets.inserted.download()[0] == 0);
        REQUIRE(report.stored == 8);
        REQUIRE(report.dropped == std::uint64_t{count} - 8 + many_inserts);
        REQUIRE(report.attempted == report.stored + report.dropped);
        REQUIRE(presets.count_of(lists, 3) ==
                std::max(count, std::min(count + many_inserts, count_max)));
        REQUIRE(lists.lengths().total == 8);
    }
}

TEST_CASE("a cell that counted up to 2^31 inserts is sound", "[accounting]") {
    for (const cl_uint count : {8u, 0x7FFFFFFFu - many_inserts, count_max - many_inserts}) {
        INFO("count " << count);
        Lists<Item> lists(device(), {50},
                          {.storage = Storage::fixed, .overflow = Overflow::drop, .slots = 8});
        Presets presets(lists);
        lists.build([&] {
            presets.preset.run(1, lists, cl_uint{3}, count);
            presets.insert.run(many_inserts, lists, cl_uint{3}, presets.inserted);
        });
        require_sound(lists, 8);
    }
}

TEST_CASE("a cell that saw more than 2^31 inserts is sound", "[accounting]") {
    Lists<Item> lists(device(), {50},
                      {.storage = Storage::fixed, .overflow = Overflow::drop, .slots = 8});
    Presets presets(lists);
    lists.build([&] {
        presets.preset.run(1, lists, cl_uint{3}, count_max - 10);
        presets.insert.run(many_inserts, lists, cl_uint{3}, presets.inserted);
    });
    require_sound(lists, 8);
}

TEST_CASE("slots do not grow to a list that no device holds", "[accounting]") {
    Lists<Item> lists(device(), {50}, {.storage = Storage::fixed, .slots = 8});
    Presets presets(lists);
    const auto error = error_of<OverflowError>([&] {
        lists.build([&] {
            presets.preset.run(1, lists, cl_uint{3}, count_max - 10);
            presets.insert.run(many_inserts, lists, cl_uint{3}, presets.inserted);
        });
    });
    INFO(error.what());
    REQUIRE(contains(error.what(), std::to_string(50 * std::uint64_t{count_max})));
    REQUIRE(error.report().dropped == std::uint64_t{count_max} - 10 - 8 + many_inserts);
    require_sound(lists, 0);
    CELLIST_RANDOM(random, 220u);
    require_complete(Inserter(lists).build(lists, random_inserts(144, 50, random)), 144);
}

TEST_CASE("counted drops exactly what is more than its pool holds, near 2^31 and 2^32",
          "[accounting]") {
    for (const cl_uint capacity : {0u, 1u, 100u})
        for (const cl_uint count : {5u, 0x7FFFFFFFu - many_inserts, 0x7FFFFFF0u, 0x7FFFFFFFu,
                                    count_max, count_max + 100'000u}) {
            INFO("capacity " << capacity << ", count " << count);
            Lists<Item> lists(device(), {50},
                              {.storage = Storage::counted,
                               .overflow = Overflow::drop,
                               .capacity_nodes = capacity});
            Presets presets(lists);
            const BuildReport report = lists.build([&] {
                for (const cl_uint cell : {0u, 1u, 2u}) presets.preset.run(1, lists, cell, count);
                presets.insert.run(many_inserts, lists, cl_uint{1}, presets.inserted);
            });
            const std::uint64_t attempted = 3 * std::uint64_t{count} + many_inserts;
            REQUIRE(report.attempted == attempted);
            REQUIRE(report.stored == capacity);
            REQUIRE(report.dropped == attempted - capacity);
            REQUIRE(presets.count_of(lists, 1) ==
                    std::max(count, std::min(count + many_inserts, count_max)));
            require_sound(lists, capacity);
        }
}

TEST_CASE("counted does not grow to a demand that no device holds", "[accounting]") {
    Lists<Item> lists(device(), {50}, {.storage = Storage::counted});
    Presets presets(lists);
    const auto error = error_of<OverflowError>([&] {
        lists.build([&] {
            for (const cl_uint cell : {0u, 1u, 2u})
                presets.preset.run(1, lists, cell, count_max - 10);
            presets.insert.run(many_inserts, lists, cl_uint{1}, presets.inserted);
        });
    });
    INFO(error.what());
    const std::uint64_t demand = 3 * std::uint64_t{count_max - 10} + many_inserts;
    REQUIRE(contains(error.what(), std::to_string(demand)));
    REQUIRE(error.report().attempted == demand);
    require_sound(lists, 0);
    CELLIST_RANDOM(random, 221u);
    require_complete(Inserter(lists).build(lists, random_inserts(144, 50, random)), 144);
}

}  // namespace
}  // namespace cellist::test
