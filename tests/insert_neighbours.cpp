// SPDX-License-Identifier: MIT
// Neighbours that share a cell, in every constellation of work-items: where the device has lanes,
// they link to each other first.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto insert_neighbours_source = R"(
#include <cellist/lists.clh>

// Which work-items take part, by mask: a bit for each of 32 in a row, moved on from row to row.
static int takes_part(uint i, uint mask)
{
    const uint turn = i / 32 % 32;
    return (mask >> (i + turn) % 32) & 1;
}

kernel void masked(CELLIST_LISTS(Item, lists), global const uint* cells, uint mask)
{
    const uint i = get_global_id(0);
    Item item = { (float)mask, i };
    if (takes_part(i, mask)) cellist_insert(lists, cells[i], item);
}

// The same cell of two containers, in the same instruction if a compiler sees fit.
kernel void two_containers(CELLIST_LISTS(Item, a), CELLIST_LISTS(Item, b), global const uint* cells)
{
    const uint i = get_global_id(0);
    Item item = { 0.0f, i };
    if (i % 3 == 1) cellist_insert(a, cells[i], item);
    else cellist_insert(b, cells[i], item);
    const uint cell = cells[i];
    if (i % 2) { item.key = 1.0f; cellist_insert(a, cell, item); }
    else { item.key = 2.0f; cellist_insert(a, cell, item); }
}

// Work-items that leave loops at different times, return early, and insert from several places.
kernel void wild(CELLIST_LISTS(Item, lists), global const uint* cells, uint count)
{
    const uint i = get_global_id(0);
    if (i >= count || i % 29 == 28) return;
    for (uint k = 0; k < 6; ++k) {
        Item item = { (float)k, i };
        if (k == i % 11) break;
        switch ((i >> 1) % 4) {
            case 0: cellist_insert(lists, cells[i], item); break;
            case 1: if (k % 2) continue;
            case 2: cellist_insert(lists, cells[i / 2], item); break;
            default: cellist_insert(lists, cells[(i + k) % count], item);
        }
        if (i % 7 == k) return;
    }
}
)";

/// Cells in runs of one cell, in cells that alternate, in one cell, and at random among few.
std::vector<std::vector<cl_uint>> patterns(std::size_t count, cl_uint cells, std::mt19937& random) {
    std::vector<std::vector<cl_uint>> all;
    for (const std::size_t run : {1u, 2u, 3u, 5u, 16u, 31u, 32u, 33u, 100u}) {
        std::vector<cl_uint> pattern;
        for (std::size_t i = 0; i < count; ++i)
            pattern.push_back(static_cast<cl_uint>(i / run * 7 % cells));
        all.push_back(pattern);
    }
    for (const cl_uint among : {1u, 2u, 3u, 10u}) {
        std::vector<cl_uint> pattern;
        for (std::size_t i = 0; i < count; ++i) pattern.push_back(below(random, among));
        all.push_back(pattern);
    }
    std::vector<cl_uint> in_turn;
    for (std::size_t i = 0; i < count; ++i) in_turn.push_back(static_cast<cl_uint>(i % 2 * 3));
    all.push_back(in_turn);
    return all;
}

TEST_CASE("neighbours share cells, whichever work-items take part") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 310u);
    constexpr cl_uint count = 2048;
    Lists<Item> lists(device(), {61}, {.storage = storage, .capacity_nodes = count, .slots = 64});
    Kernel kernel(device(), insert_neighbours_source, "masked", lists);
    std::size_t number = 0;
    for (const std::vector<cl_uint>& pattern : patterns(count, 61, random)) {
        const Buffer<cl_uint> cells(device(), pattern);
        for (const cl_uint mask : {0xFFFFFFFFu, 0x00000001u, 0x80000000u, 0x55555555u, 0xFFFF0000u,
                                   0x0FF0F0F1u, 0x7FFFFFFFu, static_cast<cl_uint>(random())}) {
            INFO("pattern " << number << ", mask " << mask);
            Oracle<Item> oracle;
            for (cl_uint i = 0; i < count; ++i)
                if (((mask >> (i + i / 32 % 32) % 32) & 1) != 0)
                    oracle.emplace(pattern[i], Item{static_cast<cl_float>(mask), i});
            require_complete(lists.build(kernel, count, cells, mask), oracle.size());
            require_sound(lists, oracle.size());
            require_same(lists.download(), oracle);
        }
        ++number;
    }
}

TEST_CASE("neighbours share a cell's index in two containers") {
    CELLIST_RANDOM(random, 311u);
    constexpr cl_uint count = 2048;
    for (const Storage storage : all_storages)
        for (const std::vector<cl_uint>& pattern : patterns(count, 61, random)) {
            INFO("storage " << name_of(storage));
            Lists<Item> a(device(), {61}, {.storage = storage});
            Lists<Item> b(device(), {61}, {.storage = storage});
            Kernel kernel(device(), insert_neighbours_source, "two_containers", a, b);
            const Buffer<cl_uint> cells(device(), pattern);
            cellist::build([&] { kernel.run(count, a, b, cells); }, a, b);
            Oracle<Item> in_a, in_b;
            for (cl_uint i = 0; i < count; ++i) {
                (i % 3 == 1 ? in_a : in_b).emplace(pattern[i], Item{0.0f, i});
                in_a.emplace(pattern[i], Item{i % 2 != 0 ? 1.0f : 2.0f, i});
            }
            require_sound(a, in_a.size());
            require_sound(b, in_b.size());
            require_same(a.download(), in_a);
            require_same(b.download(), in_b);
        }
}

TEST_CASE("neighbours share cells in wild control flow, until the pool is full") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 312u);
    constexpr cl_uint count = 2048;
    for (const std::vector<cl_uint>& pattern : patterns(count, 61, random)) {
        Oracle<Item> oracle;
        for (cl_uint i = 0; i < count; ++i) {
            if (i % 29 == 28) continue;
            for (cl_uint k = 0; k < 6; ++k) {
                if (k == i % 11) break;
                const cl_uint place = (i >> 1) % 4;
                if (place == 1 && k % 2 != 0) continue;
                const cl_uint from = place == 0 ? i : place < 3 ? i / 2 : (i + k) % count;
                oracle.emplace(pattern[from], Item{static_cast<cl_float>(k), i});
                if (i % 7 == k) break;
            }
        }
        const Buffer<cl_uint> cells(device(), pattern);
        for (const std::uint64_t capacity : {std::uint64_t{oracle.size()}, oracle.size() / 3}) {
            INFO("capacity " << capacity);
            Lists<Item> lists(device(), {61},
                              {.storage = storage,
                               .overflow = Overflow::drop,
                               .capacity_nodes = capacity,
                               .slots = static_cast<std::uint32_t>(capacity)});
            Kernel kernel(device(), insert_neighbours_source, "wild", lists);
            const BuildReport report =
                lists.build(kernel, Range::padded(count, 64), cells, cl_uint{count});
            REQUIRE(report.attempted == oracle.size());
            REQUIRE(report.rejected == 0);
            if (!has_slots(storage))
                REQUIRE(report.stored == std::min<std::uint64_t>(capacity, oracle.size()));
            require_sound(lists, report.stored);
            if (report.dropped == 0) require_same(lists.download(), oracle);
        }
    }
}

}  // namespace
}  // namespace cellist::test
