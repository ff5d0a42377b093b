// SPDX-License-Identifier: MIT
// Counters are exact in 64 bits, and no counter wraps into a node that is not free.
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto preset_counters_source = R"(
#include <cellist/lists.clh>

kernel void preset_low(CELLIST_LISTS(Item, lists), uint dropped, uint rejected)
{
    const cellist_view lists_view = cellist_view_of(lists);
    for (uint shard = 0; shard < (1u << lists_view.shard_bits); ++shard) {
        lists_shards[shard].dropped_low = dropped;
        lists_shards[shard].rejected_low = rejected;
    }
}

// `above` more than each shard has nodes.
kernel void preset_allocated(CELLIST_LISTS(Item, lists), uint above)
{
    const cellist_view lists_view = cellist_view_of(lists);
    for (uint shard = 0; shard < (1u << lists_view.shard_bits); ++shard)
        lists_shards[shard].allocated = cellist_shard_nodes(lists_view, shard) + above;
}

kernel void insert_many(CELLIST_LISTS(Item, lists), uint outside, global uint* inserted)
{
    const uint i = get_global_id(0);
    Item item = { 0.0f, i };
    if (cellist_insert(lists, i % cellist_cells(lists), item))
        atomic_inc(inserted);
    for (uint k = 0; k < outside; ++k)
        cellist_insert(lists, cellist_cells(lists) + k, item);
}

// The nodes that each shard owns, marked by the shard.
kernel void owners(CELLIST_LISTS(Item, lists), global uint* owner, global uint* repeated)
{
    const cellist_view lists_view = cellist_view_of(lists);
    for (uint shard = 0; shard < (1u << lists_view.shard_bits); ++shard)
        for (uint n = 0; n < cellist_shard_nodes(lists_view, shard); ++n) {
            const uint node = cellist_shard_address(lists_view, shard, n);
            if (node >= lists_view.pool_nodes || owner[node] != CELLIST_NONE) ++*repeated;
            else owner[node] = shard;
        }
}
)";

TEST_CASE("dropped and rejected records are counted in 64 bits") {
    for (const std::uint64_t capacity : {10u, 4096u}) {
        Lists<Item> lists(device(), {50}, {.overflow = Overflow::drop, .capacity_nodes = capacity});
        Kernel preset(device(), preset_counters_source, "preset_low", lists);
        Kernel insert(device(), preset_counters_source, "insert_many", lists);
        Buffer<cl_uint> inserted(device(), 1);
        inserted.fill(0);
        constexpr cl_uint dropped = 0xFFFFFFF0u;
        constexpr cl_uint rejected = 0xFFFFFFFFu;
        const BuildReport report = lists.build([&] {
            preset.run(1, lists, dropped, rejected);
            insert.run(9984, lists, cl_uint{3}, inserted);
        });
        const std::uint64_t shards = capacity == 10 ? 1 : 4;
        INFO("capacity " << capacity << ", shards " << shards);
        REQUIRE(report.stored == capacity);
        REQUIRE(report.dropped == shards * dropped + 9984 - capacity);
        REQUIRE(report.rejected == shards * rejected + 3 * 9984);
        REQUIRE(report.attempted == report.stored + report.dropped + report.rejected);
        REQUIRE(inserted.download()[0] == capacity);
        require_sound(lists, capacity);
    }
}

TEST_CASE("a counter past its shard's last node hands out no node") {
    for (const std::uint64_t capacity : {0u, 1u, 255u, 4099u})
        for (const cl_uint above : {0u, 1u, 100'000u, 0xFFFF'0000u - 4099u}) {
            INFO("capacity " << capacity << ", above by " << above);
            Lists<Item> lists(device(), {50},
                              {.overflow = Overflow::drop, .capacity_nodes = capacity});
            Kernel preset(device(), preset_counters_source, "preset_allocated", lists);
            Kernel insert(device(), preset_counters_source, "insert_many", lists);
            Buffer<cl_uint> inserted(device(), 1);
            inserted.fill(0);
            const BuildReport report = lists.build([&] {
                preset.run(1, lists, above);
                insert.run(5120, lists, cl_uint{0}, inserted);
            });
            REQUIRE(report.dropped == 5120);
            REQUIRE(inserted.download()[0] == 0);
            REQUIRE(lists.lengths().total == 0);
        }
}

TEST_CASE("every node of the pool belongs to exactly one shard") {
    for (const std::uint64_t capacity :
         {0u, 1u, 255u, 256u, 257u, 2047u, 2048u, 2049u, 65'537u, 262'144u, 270'123u}) {
        INFO("capacity " << capacity);
        // A pool that grows may have more nodes than its capacity.
        const Lists<Item> lists(device(), {1},
                                {.overflow = Overflow::drop, .capacity_nodes = capacity});
        Kernel owners(device(), preset_counters_source, "owners", lists);
        Buffer<cl_uint> owner(device(), capacity);
        Buffer<cl_uint> repeated(device(), 1);
        owner.fill(0xFFFFFFFFu);
        repeated.fill(0);
        owners.run(1, lists, owner, repeated);
        REQUIRE(repeated.download()[0] == 0);
        const std::vector<cl_uint> host = owner.download();
        REQUIRE(std::count(host.begin(), host.end(), 0xFFFFFFFFu) == 0);
    }
}

}  // namespace
}  // namespace cellist::test
