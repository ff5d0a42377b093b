// SPDX-License-Identifier: MIT
// Overflow::drop keeps what fits, counts the rest exactly, and keeps every list valid.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

/// Requires that every record of a cell was inserted into that cell, and no record twice.
void require_sub_multiset(const HostLists<Item>& found, const Inserts<Item>& inserts) {
    std::vector<bool> seen(inserts.size(), false);
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
        for (const Item& item : found.cell(cell)) {
            REQUIRE(item.id < inserts.size());
            REQUIRE_FALSE(seen[item.id]);
            REQUIRE(inserts.cells[item.id] == cell);
            REQUIRE(inserts.records[item.id] == item);
            seen[item.id] = true;
        }
}

void drop(std::uint64_t capacity, std::size_t demand, std::mt19937& random) {
    INFO("capacity " << capacity << ", demand " << demand);
    Lists<Item> lists(device(), {50}, {.overflow = Overflow::drop, .capacity_nodes = capacity});
    Inserts<Item> inserts = random_inserts(demand, 50, random);
    inserts.add(50, {0.0f, 0});
    const BuildReport report = Inserter(lists).build(lists, inserts);
    REQUIRE(report.attempted == demand + 1);
    REQUIRE(report.stored == std::min<std::uint64_t>(capacity, demand));
    REQUIRE(report.dropped == demand - report.stored);
    REQUIRE(report.rejected == 1);
    REQUIRE(report.passes == 1);
    REQUIRE(report.capacity_nodes == capacity);
    require_sound(lists, report.stored);
    require_sub_multiset(lists.download(), inserts);
}

TEST_CASE("drop keeps as many records as there are nodes") {
    CELLIST_RANDOM(random, 50u);
    for (const std::uint64_t capacity : {0u, 1u, 143u, 144u, 145u}) drop(capacity, 144, random);
    for (const std::uint64_t capacity :
         {1u, 255u, 256u, 257u, 511u, 1023u, 1024u, 1025u, 2047u, 2048u, 2049u, 4095u, 4096u})
        drop(capacity, 4096, random);
}

TEST_CASE("drop keeps as many records as there are nodes, at random capacities") {
    CELLIST_RANDOM(random, 51u);
    for (int i = 0; i < 25; ++i) {
        const std::uint64_t capacity = below(random, 70'000);
        drop(capacity, capacity + below(random, 5) - std::min<std::uint64_t>(capacity, 2), random);
    }
}

TEST_CASE("a tiny pool survives a huge demand") {
    CELLIST_RANDOM(random, 52u);
    drop(3, 1'000'000, random);
    drop(1500, 1'000'000, random);
}

constexpr auto one_group_source = R"(
#include <cellist/lists.clh>

// Every work-item of the only work-group inserts until `count` records were inserted together.
kernel void one_group(CELLIST_LISTS(Item, lists), uint count)
{
    for (uint i = get_global_id(0); i < count; i += get_global_size(0)) {
        Item item = { 0.0f, i };
        cellist_insert(lists, i % cellist_cells(lists), item);
    }
}
)";

TEST_CASE("one work-group fills every node of the pool before a record is refused") {
    const Lists<Item> any(device(), {1});
    Kernel kernel(device(), one_group_source, "one_group", any);
    for (const cl_uint capacity : {1u, 63u, 255u, 256u, 257u, 1023u, 1024u, 1025u, 2047u, 2048u,
                                   3333u, 65'535u, 65'536u, 262'143u, 262'144u, 300'001u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(device(), {50}, {.overflow = Overflow::drop, .capacity_nodes = capacity});
        Range range(64);
        range.local = {64, 1, 1};
        BuildReport report = lists.build(kernel, range, capacity);
        require_complete(report, capacity);
        require_sound(lists, capacity);

        report = lists.build(kernel, range, capacity + 77);
        REQUIRE(report.stored == capacity);
        REQUIRE(report.dropped == 77);
        require_sound(lists, capacity);
    }
}

}  // namespace
}  // namespace cellist::test
