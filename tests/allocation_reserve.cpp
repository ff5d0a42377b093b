// Reservations: links are stored, dropped or rejected like inserts, however many of them follow, and
// what is reserved and not linked passes for nothing else.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto source = R"(
#include <cellist/lists.clh>

// Work-item i expects expected[i] links and makes links[i]; every tenth leads out of the shape.
kernel void link_some(CELLIST_LISTS(Item, lists), global const uint* expected,
                      global const uint* links, uint each, global uint* stored)
{
    const uint i = get_global_id(0);
    cellist_reservation nodes = cellist_reserve(lists, expected[i]);
    uint count = 0;
    for (uint k = 0; k < links[i]; ++k) {
        Item item = { (float)k, i * each + k };
        const uint cell = k % 10 == 9 ? CELLIST_NONE : (i + k) % cellist_cells(lists);
        count += cellist_link(lists, cell, nodes, item);
    }
    stored[i] = count;
}

// Two reservations at a time, and inserts between the links.
kernel void interleave(CELLIST_LISTS(Item, lists))
{
    const uint i = get_global_id(0);
    cellist_reservation first = cellist_reserve(lists, 3);
    cellist_reservation second = cellist_reserve(lists, (long)i % 5);
    for (uint k = 0; k < 4; ++k) {
        Item item = { (float)k, i };
        cellist_link(lists, i % cellist_cells(lists), first, item);
        item.key += 10;
        if (i % 3) cellist_link(lists, (i + k) % cellist_cells(lists), second, item);
        item.key += 10;
        if (k == 1) cellist_insert(lists, 0, item);
    }
}

static void link_through(CELLIST_LISTS(Item, lists), cellist_reservation* nodes, uint cell, uint id)
{
    Item item = { 0.0f, id };
    cellist_link(lists, cell, *nodes, item);
}

kernel void through_function(CELLIST_LISTS(Item, lists), int expected)
{
    const uint i = get_global_id(0);
    cellist_reservation nodes = cellist_reserve(lists, expected);
    for (uint k = 0; k < 3; ++k) link_through(CELLIST_PASS(lists), &nodes, k, i * 3 + k);
}

kernel void reserve_only(CELLIST_LISTS(Item, lists), uint n) { cellist_reserve(lists, n); }

// The first node that was reserved and not linked becomes the head of a cell.
kernel void link_unlinked(CELLIST_LISTS(Item, lists), uint cell, global uint* found)
{
    const cellist_view lists_view = cellist_view_of(lists);
    for (uint node = 0; node < lists_view.capacity_nodes; ++node)
        if (lists_nodes[node].next == CELLIST_UNLINKED) {
            lists_heads[cell] = node;
            *found = 1;
            return;
        }
}

// As if so many records had been dropped, and nodes been missed, in each shard already.
kernel void preset(CELLIST_LISTS(Item, lists), uint dropped, uint missing)
{
    const cellist_view lists_view = cellist_view_of(lists);
    for (uint shard = 0; shard < (1u << lists_view.shard_bits); ++shard) {
        lists_shards[shard].dropped_low = dropped;
        lists_shards[shard].missing_low = missing;
    }
}
kernel void preset_allocated(CELLIST_LISTS(Item, lists), uint above)
{
    const cellist_view lists_view = cellist_view_of(lists);
    for (uint shard = 0; shard < (1u << lists_view.shard_bits); ++shard)
        lists_shards[shard].allocated = cellist_shard_nodes(lists_view, shard) + above;
}
kernel void read_missing(CELLIST_LISTS(Item, lists), global ulong* missing)
{
    const cellist_view lists_view = cellist_view_of(lists);
    *missing = 0;
    for (uint shard = 0; shard < (1u << lists_view.shard_bits); ++shard)
        *missing += (ulong)lists_shards[shard].missing_high << 32 | lists_shards[shard].missing_low;
}
)";

/// What each work-item expects and does.
struct Plan {
    std::vector<cl_uint> expected;
    std::vector<cl_uint> links;
    cl_uint each = 1;  ///< at least the most links

    void add(cl_uint expects, cl_uint makes) {
        expected.push_back(expects);
        links.push_back(makes);
        each = std::max(each, makes);
    }
    [[nodiscard]] std::uint64_t demand() const {
        std::uint64_t sum = 0;
        for (const cl_uint count : links) sum += count - count / 10;
        return sum;
    }
    [[nodiscard]] std::uint64_t rejected() const {
        std::uint64_t sum = 0;
        for (const cl_uint count : links) sum += count / 10;
        return sum;
    }
    [[nodiscard]] Oracle<Item> oracle(cl_uint cells) const {
        Oracle<Item> all;
        for (cl_uint i = 0; i < links.size(); ++i)
            for (cl_uint k = 0; k < links[i]; ++k)
                if (k % 10 != 9)
                    all.emplace((i + k) % cells, Item{static_cast<cl_float>(k), i * each + k});
        return all;
    }
};

/// The storages, and the linked one with every allocation.
#define CELLIST_EACH_KIND(storage, allocation)                                                     \
    const auto [storage, allocation] = GENERATE(std::pair(Storage::linked, Allocation::sharded),   \
                                                std::pair(Storage::linked, Allocation::global),    \
                                                std::pair(Storage::linked, Allocation::reserved),  \
                                                std::pair(Storage::counted, Allocation::reserved), \
                                                std::pair(Storage::fixed, Allocation::reserved));  \
    INFO("storage " << name_of(storage) << ", allocation " << name_of(allocation))

struct Outcome {
    BuildReport report;
    std::uint64_t stored = 0;  ///< links that said so
};

Outcome run(Lists<Item>& lists, const Plan& plan) {
    Kernel kernel(device(), source, "link_some", lists);
    const Buffer<cl_uint> expected(device(), plan.expected);
    const Buffer<cl_uint> links(device(), plan.links);
    const Buffer<cl_uint> stored(device(), plan.links.size());
    Outcome outcome;
    outcome.report = lists.build(kernel, plan.links.size(), expected, links, plan.each, stored);
    for (const cl_uint count : stored.download()) outcome.stored += count;
    return outcome;
}

/// Plans of work-items that expect too many links, too few, none, or far more than a pool holds.
std::vector<Plan> plans(std::mt19937& random) {
    std::vector<Plan> all(7);
    for (cl_uint i = 0; i < 500; ++i) {
        all[0].add(i % 12, i % 12);                                      // as many
        all[1].add(8, i % 9);                                            // fewer
        all[2].add(i % 4, 7);                                            // more
        all[3].add(0, i % 3);                                            // none expected
        all[4].add(5, 0);                                                // none made
        all[5].add(below(random, 40), below(random, 40));                // any
        all[6].add(i % 100 == 0 ? 700 : 1, i % 200 == 0 ? 700 : i % 2);  // some very many
    }
    Plan huge;
    huge.add(0xFFFFFFFFu, 300);
    huge.add(0x80000000u, 3);
    all.push_back(huge);
    return all;
}

TEST_CASE("links are stored whatever was reserved for them") {
    CELLIST_EACH_KIND(storage, allocation);
    CELLIST_RANDOM(random, 300u);
    std::size_t number = 0;
    for (const Plan& plan : plans(random)) {
        INFO("plan " << number++);
        Lists<Item> lists(
            device(), {31},
            {.storage = storage, .capacity_nodes = 100'000, .allocation = allocation});
        const Outcome outcome = run(lists, plan);
        require_complete(outcome.report, plan.demand(), plan.rejected());
        REQUIRE(outcome.stored == plan.demand());
        require_sound(lists, plan.demand());
        require_same(lists.download(), plan.oracle(31));
    }
}

TEST_CASE("a pool grows to what reservations need in one more pass") {
    CELLIST_EACH_KIND(storage, allocation);
    CELLIST_RANDOM(random, 301u);
    std::size_t number = 0;
    for (const Plan& plan : plans(random))
        for (const std::uint64_t capacity : {0u, 1u, 1000u}) {
            INFO("plan " << number++ / 3 << ", capacity " << capacity);
            Lists<Item> lists(device(), {31},
                              {.storage = storage,
                               .capacity_nodes = capacity,
                               .slots = 0,
                               .allocation = allocation});
            const Outcome outcome = run(lists, plan);
            require_complete(outcome.report, plan.demand(), plan.rejected());
            REQUIRE(outcome.report.passes <= 2);
            require_sound(lists, plan.demand());
            require_same(lists.download(), plan.oracle(31));
        }
}

TEST_CASE("links that find no node are dropped and counted") {
    CELLIST_EACH_KIND(storage, allocation);
    CELLIST_RANDOM(random, 302u);
    std::size_t number = 0;
    for (const Plan& plan : plans(random))
        for (const std::uint64_t capacity : {0u, 1u, 300u, 2100u}) {
            INFO("plan " << number++ / 4 << ", capacity " << capacity);
            Lists<Item> lists(device(), {31},
                              {.storage = storage,
                               .overflow = Overflow::drop,
                               .capacity_nodes = capacity,
                               .slots = static_cast<std::uint32_t>(capacity / 31),
                               .allocation = allocation});
            const Outcome outcome = run(lists, plan);
            REQUIRE(outcome.report.rejected == plan.rejected());
            REQUIRE(outcome.report.stored + outcome.report.dropped == plan.demand());
            REQUIRE(outcome.report.stored <= lists.capacity_nodes());
            if (storage == Storage::linked) REQUIRE(outcome.stored == outcome.report.stored);
            require_sound(lists, outcome.report.stored);
            const Oracle<Item> all = plan.oracle(31);
            const HostLists<Item> found = lists.download();
            REQUIRE(found.records().size() == outcome.report.stored);
            for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
                for (const Item& item : found.cell(cell)) {
                    const auto [begin, end] = all.equal_range(cell);
                    REQUIRE(std::count_if(begin, end, [&](const auto& entry) {
                                return entry.second == item;
                            }) == 1);
                }
        }
}

TEST_CASE("reservations that are used up leave no node over") {
    const Allocation allocation =
        GENERATE(Allocation::sharded, Allocation::global, Allocation::reserved);
    for (const cl_uint each : {1u, 2u, 8u, 256u, 257u, 1000u})
        for (const std::uint64_t capacity : {1000u, 70'000u}) {
            INFO(each << " records each, capacity " << capacity);
            Plan plan;
            for (cl_uint i = 0; i < 100; ++i) plan.add(each - each / 10, each);
            Lists<Item> lists(
                device(), {31},
                {.overflow = Overflow::drop, .capacity_nodes = capacity, .allocation = allocation});
            const Outcome outcome = run(lists, plan);
            REQUIRE(outcome.report.stored == std::min(plan.demand(), capacity));
            require_sound(lists, outcome.report.stored);
        }
}

TEST_CASE("reservations and inserts are made side by side") {
    CELLIST_EACH_KIND(storage, allocation);
    for (const std::uint64_t capacity : {0u, 500u, 20'000u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(
            device(), {9},
            {.storage = storage, .capacity_nodes = capacity, .slots = 1, .allocation = allocation});
        Kernel kernel(device(), source, "interleave", lists);
        Oracle<Item> oracle;
        for (cl_uint i = 0; i < 1000; ++i)
            for (cl_uint k = 0; k < 4; ++k) {
                oracle.emplace(i % 9, Item{static_cast<cl_float>(k), i});
                if (i % 3 != 0) oracle.emplace((i + k) % 9, Item{static_cast<cl_float>(k + 10), i});
                if (k == 1) oracle.emplace(0, Item{static_cast<cl_float>(k + 20), i});
            }
        const BuildReport report = lists.build(kernel, 1000);
        require_complete(report, oracle.size());
        REQUIRE(report.passes <= 2);
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
    }
}

TEST_CASE("reservations are handed to functions, and negative numbers reserve nothing") {
    CELLIST_EACH_KIND(storage, allocation);
    for (const cl_int expected : {-1, 0, 2, 3, 100}) {
        Lists<Item> lists(device(), {9},
                          {.storage = storage, .capacity_nodes = 64, .allocation = allocation});
        Kernel kernel(device(), source, "through_function", lists);
        require_complete(lists.build(kernel, 100, expected), 300);
        Oracle<Item> oracle;
        for (cl_uint i = 0; i < 300; ++i) oracle.emplace(i % 3, Item{0.0f, i});
        require_same(lists.download(), oracle);
        if (storage == Storage::linked && expected <= 3) REQUIRE(lists.capacity_nodes() == 300);
    }
}

TEST_CASE("a few reservations overflow a small pool", "[oclgrind]") {
    Plan plan;
    for (cl_uint i = 0; i < 40; ++i) plan.add(4, 1 + i % 4);
    for (const std::uint64_t capacity : {61u, 200u}) {
        Lists<Item> lists(device(), {5},
                          {.overflow = Overflow::drop,
                           .capacity_nodes = capacity,
                           .allocation = Allocation::reserved});
        const Outcome outcome = run(lists, plan);
        REQUIRE(outcome.report.stored + outcome.report.dropped == plan.demand());
        REQUIRE((outcome.report.dropped == 0) == (capacity == 200));
        require_sound(lists, outcome.report.stored);
    }
}

TEST_CASE("nodes that are reserved and not linked are not stored, and no list leads to them") {
    const Allocation allocation = GENERATE(Allocation::sharded, Allocation::reserved);
    const bool takes_nodes = allocation == Allocation::reserved;
    Lists<Item> lists(
        device(), {31},
        {.overflow = Overflow::drop, .capacity_nodes = 3000, .allocation = allocation});
    Kernel kernel(device(), source, "reserve_only", lists);
    for (const cl_uint n : {2u, 100u, 0xFFFFFFFFu}) {
        const BuildReport report = lists.build(kernel, 200, n);
        REQUIRE(report.attempted == 0);
        REQUIRE(report.stored == 0);
        require_sound(lists, 0);
    }

    Plan plan;
    for (cl_uint i = 0; i < 100; ++i) plan.add(8, 5);
    REQUIRE(run(lists, plan).report.stored == 500);
    require_sound(lists, 500);
    lists.sort(&Item::key);
    require_sound(lists, 500);
    REQUIRE(run(lists, plan).report.stored == 500);
    // Where no nodes were reserved, what lies in the pool is anything.
    if (takes_nodes) {
        Kernel corrupt(device(), source, "link_unlinked", lists);
        Buffer<cl_uint> found(device(), 1);
        found.fill(0);
        corrupt.run(1, lists, cl_uint{4}, found);
        REQUIRE(found.download()[0] == 1);
        const Validation validation = lists.validate();
        REQUIRE_FALSE(validation.ok());
        REQUIRE(validation.first_bad_cell == 4);
    }

    // The next build knows nothing of it.
    Plan next;
    for (cl_uint i = 0; i < 100; ++i) next.add(5, 5);
    require_complete(run(lists, next).report, 500);
    require_sound(lists, 500);
    lists.clear();
    require_sound(lists, 0);
}

TEST_CASE("outside of a build a reservation takes no nodes and links are refused") {
    Lists<Item> lists(device(), {9}, {.capacity_nodes = 100, .allocation = Allocation::reserved});
    Kernel through(device(), source, "through_function", lists);
    require_complete(lists.build(through, 10, cl_int{3}), 30);
    through.run(10, lists, cl_int{3});
    const Validation validation = lists.validate();
    REQUIRE(validation.late_inserts == 30);
    REQUIRE(validation.broken_links + validation.repeated_nodes + validation.lost_nodes == 0);
    REQUIRE(lists.lengths().total == 30);
}

TEST_CASE("a build in slices needs no room for reservations") {
    CELLIST_EACH_KIND(storage, allocation);
    Plan plan;
    for (cl_uint i = 0; i < 300; ++i) plan.add(50, 9);
    for (const std::uint64_t capacity : {300u, 2700u}) {
        INFO("capacity " << capacity);
        Lists<Item> lists(device(), {31},
                          {.storage = storage,
                           .overflow = Overflow::drop,
                           .capacity_nodes = capacity,
                           .slots = static_cast<std::uint32_t>(capacity / 3),
                           .allocation = allocation});
        Kernel kernel(device(), source, "link_some", lists);
        const Buffer<cl_uint> expected(device(), plan.expected);
        const Buffer<cl_uint> links(device(), plan.links);
        const Buffer<cl_uint> stored(device(), plan.links.size());
        Oracle<Item> oracle = plan.oracle(31);
        std::uint64_t read = 0;
        const BuildReport report = lists.build_slices(
            [&] { kernel.run(plan.links.size(), lists, expected, links, plan.each, stored); },
            [&](const Slice& slice) {
                const HostLists<Item> found = lists.download();
                for (std::uint64_t cell = slice.first_cell; cell < slice.first_cell + slice.cells;
                     ++cell)
                    read += found.cell(cell).size();
            });
        REQUIRE(report.dropped == 0);
        REQUIRE(report.stored == plan.demand());
        REQUIRE(read == plan.demand());
    }
}

TEST_CASE("counters near 2^32 stay exact when reservations find no nodes", "[accounting]") {
    constexpr cl_uint dropped = 0xFFFFFFF0u;
    for (const cl_uint missing : {0u, 0xFFFFFFF0u}) {
        Lists<Item> lists(
            device(), {9},
            {.overflow = Overflow::drop, .capacity_nodes = 10, .allocation = Allocation::reserved});
        Kernel preset(device(), source, "preset", lists);
        Kernel links(device(), source, "through_function", lists);
        Kernel read(device(), source, "read_missing", lists);
        for (const cl_int expected : {2, 3, 40}) {
            const BuildReport report = lists.build([&] {
                preset.run(1, lists, dropped, missing);
                links.run(100, lists, expected);
            });
            // Reservations of the first work-items hold nodes that others need.
            REQUIRE(report.stored <= 10);
            REQUIRE(report.stored > 0);
            REQUIRE(report.dropped == std::uint64_t{dropped} + 300 - report.stored);
            require_sound(lists, report.stored);
            const Buffer<cl_ulong> device_sum(device(), 1);
            read.run(1, lists, device_sum);
            const cl_ulong sum = device_sum.download()[0];
            if (expected <= 3) REQUIRE(sum == missing);
            if (expected == 40)
                REQUIRE(sum == missing + std::uint64_t{100} * 40 - 10 - 300 + report.stored);
        }
    }
}

TEST_CASE("a counter past its shard's last node gives reservations no node", "[accounting]") {
    for (const Allocation allocation : all_allocations)
        for (const std::uint64_t capacity : {0u, 1u, 255u, 4099u})
            for (const cl_uint above : {0u, 1u, 100'000u, 0xF000'0000u}) {
                INFO("capacity " << capacity << ", above by " << above);
                Lists<Item> lists(device(), {50},
                                  {.overflow = Overflow::drop,
                                   .capacity_nodes = capacity,
                                   .allocation = allocation});
                Kernel preset(device(), source, "preset_allocated", lists);
                Kernel links(device(), source, "through_function", lists);
                const BuildReport report = lists.build([&] {
                    preset.run(1, lists, above);
                    links.run(5120, lists, cl_int{1000});
                });
                REQUIRE(report.dropped == 3 * 5120);
                REQUIRE(lists.lengths().total == 0);
            }
}

}  // namespace
}  // namespace cellist::test
