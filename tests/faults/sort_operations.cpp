// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "checks.hpp"
#include "layer.hpp"
#include "operations.hpp"

namespace cellist::test {
namespace {

/// The device keeps the programs that it builds. This one is for lists without memory for a second
/// pool.
void keep_program_without_second_pool(Scene& scene, auto sort_async) {
    const faults::Pause pause;
    Lists<Item> lists(scene.device, {1}, {.storage = scene.options.storage});
    sort_async(lists);
}

void sort_by_a_member(Scene& scene) {
    keep_program_without_second_pool(scene, [](auto& lists) { lists.sort_async(&Item::key); });
    scene.lists.sort(&Item::key);
    scene.forgive_missing_memory();
    require_sorted(contents_of(scene.lists), scene.oracle, by_key);
}

void sort_by_an_expression(Scene& scene) {
    keep_program_without_second_pool(
        scene, [](auto& lists) { lists.sort_by_async("record.id % 10", Order::descending); });
    scene.lists.sort_by("record.id % 10", Order::descending);
    scene.forgive_missing_memory();
    require_sorted(contents_of(scene.lists), scene.oracle, [](const Item& a, const Item& b) {
        if (a.id % 10 != b.id % 10) return a.id % 10 > b.id % 10;
        return by_key(a, b);
    });
}

void sort_without_blocking(Scene& scene) {
    scene.lists.sort_async(&Item::key);
    require_sorted(contents_of(scene.lists), scene.oracle, by_key);
}

/// A list of more records than are ranked together. Whatever fails, it keeps them.
void sort_a_long_list(Scene& scene) {
    constexpr cl_uint repeats = 4;
    std::optional<Lists<Item>> lists;
    std::vector<Item> expected;
    const auto found = [&] {
        const faults::Pause pause;
        require_sound(lists->validate());
        const HostLists<Item> host = lists->download();
        return std::vector<Item>(host.records().begin(), host.records().end());
    };
    {
        const faults::Pause pause;
        lists.emplace(scene.device, Shape{1}, ListsOptions{.storage = scene.options.storage});
        Buffer<cl_uint> cells(scene.device, insert_count);
        cells.fill(0);
        lists->build([&] {
            for (cl_uint i = 0; i < repeats; ++i)
                scene.insert.run(insert_range(), *lists, cells, scene.records, insert_count);
        });
        for (cl_uint i = 0; i < repeats; ++i)
            expected.insert(expected.end(), scene.inserts.records.begin(),
                            scene.inserts.records.end());
        std::sort(expected.begin(), expected.end(), by_key);
    }
    keep_program_without_second_pool(scene, [](auto& own) { own.sort_async(&Item::key); });
    try {
        lists->sort(&Item::key);
    } catch (const OpenClError&) {
        std::vector<Item> kept = found();
        std::sort(kept.begin(), kept.end(), by_key);
        REQUIRE(kept == expected);
        throw;
    }
    scene.forgive_missing_memory();
    REQUIRE(found() == expected);
}

}  // namespace

std::span<const Operation> sort_operations() {
    using enum Contents;
    using enum Use;
    static constexpr Operation table[] = {
        {"sort by a member", full, sort_by_a_member, first, Room::enough, Overflow::grow,
         Kind::plain, true},
        {"sort by an expression", full, sort_by_an_expression, repeated, Room::enough,
         Overflow::grow, Kind::plain, true},
        {"sort without blocking", full, sort_without_blocking},
        {"sort a long list", full, sort_a_long_list, repeated, Room::enough, Overflow::grow,
         Kind::plain, true},
    };
    return table;
}

}  // namespace cellist::test
