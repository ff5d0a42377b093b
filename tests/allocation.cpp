// SPDX-License-Identifier: MIT
// Allocation fills the pool to its last node, and no record is lost on the way.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto allocating_source = R"(
#include <cellist/lists.clh>

static uint item_index(void)
{
    return get_global_id(0) + get_global_size(0) *
           (get_global_id(1) + get_global_size(1) * get_global_id(2));
}

static uint cell_of(uint i, uint run, uint cells) { return i / run * 7 % cells; }

// Each of these inserts `each` records a work-item; record k of item i has the id i * each + k.
kernel void by_insert(CELLIST_LISTS(Item, lists), uint run, uint each)
{
    const uint i = item_index();
    for (uint k = 0; k < each; ++k) {
        Item item = { (float)k, i * each + k };
        cellist_insert(lists, cell_of(i, run, cellist_cells(lists)), item);
    }
}

// The same from two branches and with a trip count of its own for each work-item.
kernel void by_divergent_insert(CELLIST_LISTS(Item, lists), uint run, uint each)
{
    const uint i = item_index();
    const uint cell = cell_of(i, run, cellist_cells(lists));
    const uint first = i % (each + 1);
    for (uint k = 0; k < first; ++k) {
        Item item = { (float)k, i * each + k };
        cellist_insert(lists, cell, item);
    }
    for (uint k = first; k < each; ++k) {
        Item item = { (float)k, i * each + k };
        if (k % 2) cellist_insert(lists, cell, item);
        else cellist_insert(lists, cell, item);
    }
}

)";

constexpr std::array kernels{"by_insert", "by_divergent_insert"};

cl_uint cell_of(cl_uint i, cl_uint run, cl_uint cells) { return i / run * 7 % cells; }

/// Whether each record that is in a list was inserted there, and none is there twice.
bool is_sub_multiset(const HostLists<Item>& found, cl_uint items, cl_uint run, cl_uint each) {
    std::vector<bool> seen(std::size_t{items} * each, false);
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
        for (const Item& item : found.cell(cell)) {
            if (item.id >= seen.size() || seen[item.id]) return false;
            if (cell_of(item.id / each, run, static_cast<cl_uint>(found.cells())) != cell)
                return false;
            if (item.key != static_cast<cl_float>(item.id % each)) return false;
            seen[item.id] = true;
        }
    return true;
}

struct Ranges {
    Range range;
    cl_uint items;
};

/// 1024 work-items in work-groups of several sizes and dimensions.
std::vector<Ranges> ranges() {
    std::vector<Ranges> all;
    for (const std::size_t group : {1u, 2u, 32u, 64u, 256u, 1024u}) {
        if (group > device().info().max_work_group_size) continue;
        Range range(1024);
        range.local = {group, 1, 1};
        all.push_back({range, 1024});
    }
    Range odd(1001);
    odd.local = {7, 1, 1};
    all.push_back({odd, 1001});
    Range plane({32, 32});
    plane.local = {8, 4, 1};
    all.push_back({plane, 1024});
    Range space({16, 8, 8});
    space.local = {4, 4, 2};
    all.push_back({space, 1024});
    return all;
}

void fill(const char* name, Storage storage, const Ranges& over, std::uint64_t capacity,
          cl_uint run, cl_uint each) {
    INFO(name << ", storage " << name_of(storage) << ", work-groups of " << over.range.local[0]
              << ", " << over.range.local[1] << ", " << over.range.local[2] << ", capacity "
              << capacity << ", runs of " << run << ", " << each << " records each");
    Lists<Item> lists(device(), {50},
                      {.storage = storage,
                       .overflow = Overflow::drop,
                       .capacity_nodes = capacity,
                       .slots = static_cast<std::uint32_t>(capacity)});
    Kernel kernel(device(), allocating_source, name, lists);
    const BuildReport report = lists.build(kernel, over.range, run, each);
    const std::uint64_t attempted = std::uint64_t{over.items} * each;
    std::uint64_t stored = std::min(attempted, capacity);
    if (has_slots(storage)) {
        std::vector<std::uint64_t> demand(50);
        for (cl_uint i = 0; i < over.items; ++i) demand[cell_of(i, run, 50)] += each;
        stored = 0;
        for (const std::uint64_t records : demand) stored += std::min(records, capacity);
    }
    REQUIRE(report.attempted == attempted);
    REQUIRE(report.stored == stored);
    REQUIRE(report.dropped == attempted - stored);
    REQUIRE(report.rejected == 0);
    require_sound(lists, stored);
    REQUIRE(is_sub_multiset(lists.download(), over.items, run, each));
}

TEST_CASE("inserts fill the pool to its last node, from work-groups of any form") {
    for (const char* name : kernels)
        for (const Ranges& over : ranges())
            for (const std::uint64_t capacity :
                 {std::uint64_t{over.items} * 3 - 1, std::uint64_t{over.items} * 3,
                  std::uint64_t{over.items} * 3 + 1})
                fill(name, Storage::linked, over, capacity, 5, 3);
}

TEST_CASE("inserts fill pools of any size, whoever shares a cell") {
    const Ranges over = ranges()[3];
    for (const char* name : kernels)
        for (const std::uint64_t capacity : {0u, 1u, 255u, 256u, 2048u, 4099u})
            for (const cl_uint run : {1u, 2u, 16u, 40u, 1024u})
                for (const cl_uint each : {1u, 5u})
                    fill(name, Storage::linked, over, capacity, run, each);
}

TEST_CASE("straight and divergent inserts serve every storage") {
    const Ranges over = ranges()[3];
    for (const char* name : kernels)
        for (const Storage storage : all_storages)
            for (const std::uint64_t capacity : {0u, 20u, 3000u, 10'000u})
                for (const cl_uint run : {1u, 16u, 1024u})
                    fill(name, storage, over, capacity, run, 3);
}

TEST_CASE("straight and divergent inserts grow the pool to the exact demand") {
    CELLIST_EACH_STORAGE(storage);
    for (const char* name : kernels)
        for (const cl_uint each : {1u, 8u, 300u}) {
            INFO(name << ", " << each << " records each");
            Lists<Item> lists(device(), {50},
                              {.storage = storage, .capacity_nodes = 5000, .slots = 1});
            Kernel kernel(device(), allocating_source, name, lists);
            const BuildReport report = lists.build(kernel, 4096, cl_uint{3}, each);
            require_complete(report, std::uint64_t{4096} * each);
            if (each > 1) REQUIRE(report.passes == 2);
            if (storage == Storage::linked)
                REQUIRE(report.capacity_nodes == std::max(5000u, 4096 * each));
            require_sound(lists, std::uint64_t{4096} * each);
            REQUIRE(is_sub_multiset(lists.download(), 4096, 3, each));
        }
}

// ---- per-thread blocks -------------------------------------------------------------------------

TEST_CASE("a pool that grows holds its capacity in one pass, whatever kernels insert") {
    // With threads that have nodes of their own, where the device has such, and without.
    for (const char* options : {"", "-DCELLIST_ONE_THREAD_PER_WORK_GROUP=0"}) {
        constexpr cl_uint items = 4096;
        constexpr cl_uint each = 16;
        constexpr std::uint64_t capacity = kernels.size() * items * each;
        INFO("build options '" << options << "'");
        Lists<Item> lists(device(), {50}, {.capacity_nodes = capacity});
        std::vector<Kernel> inserting;
        for (const char* name : kernels)
            inserting.emplace_back(device(), Source{.text = allocating_source, .options = options},
                                   name, lists);
        const BuildReport report = lists.build([&] {
            for (Kernel& kernel : inserting) kernel.run(items, lists, cl_uint{3}, each);
        });
        require_complete(report, capacity);
        REQUIRE(report.passes == 1);
        REQUIRE(report.capacity_nodes == capacity);
        require_sound(lists, capacity);
        std::vector<std::size_t> found(items * each);
        for (const Item& item : lists.download().records()) ++found.at(item.id);
        REQUIRE(found == std::vector<std::size_t>(items * each, kernels.size()));
        lists.sort(&Item::id);
        require_sound(lists, capacity);
    }
}

TEST_CASE("a node in the hand of a thread is free") {
    Lists<Item> lists(device(), {50}, {.capacity_nodes = 262'144});
    Kernel insert(device(), allocating_source, "by_insert", lists);
    lists.build(insert, 100, cl_uint{3}, cl_uint{1});
    require_sound(lists, 100);
    // `found`: such nodes; the first cell is made to lead to one.
    Kernel steal(device(), R"(
#include <cellist/lists.clh>
kernel void steal(CELLIST_LISTS(Item, lists), global uint* found)
{
    const cellist_view lists_view = cellist_view_of(lists);
    volatile global cellist_thread_block* blocks = cellist_thread_blocks(lists_shards, lists_view);
    *found = 0;
    for (uint i = 0; i < lists_view.thread_slots; ++i) {
        if (blocks[i].node != blocks[i].last) lists_heads[0] = blocks[i].node;
        *found += blocks[i].last - blocks[i].node + blocks[i].end - blocks[i].next;
    }
}
)",
                 "steal", lists);
    Buffer<cl_uint> found(device(), 1);
    steal.run(1, lists, found);
    if (!device().info().one_thread_per_work_group) {
        REQUIRE(found.download()[0] == 0);
        return;
    }
    REQUIRE(found.download()[0] % 256 == 256 - 100);
    REQUIRE(lists.validate().broken_links == 1);
}

}  // namespace
}  // namespace cellist::test
