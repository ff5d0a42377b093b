// SPDX-License-Identifier: MIT
// attempted == stored + dropped + rejected, and the lists hold what the report says, over random
// cases of shape, capacity, distribution, storage, policy and work-group size.
#include <iostream>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr int case_count = 10'000;

/// Which cell the i-th record of a case goes to. The device computes the same from its arguments.
enum Distribution : cl_uint {
    uniform,
    one_cell,
    half_in_one_cell,
    partly_outside,
    outside,
    in_turn
};
constexpr cl_uint distribution_count = 6;

constexpr auto insert_some_source = R"(
#include <cellist/lists.clh>

static uint scramble(uint x)
{
    x = (x ^ (x >> 16)) * 0x7FEB352Du;
    x = (x ^ (x >> 15)) * 0x846CA68Bu;
    return x ^ (x >> 16);
}

static uint cell_of(uint distribution, uint seed, uint i, uint cells)
{
    const uint number = scramble(seed + i);
    const uint any = number % max(cells, 1u);
    const uint hot = seed % max(cells, 1u);
    switch (distribution) {
        case 0: return any;
        case 1: return hot;
        case 2: return number & 0x40000000u ? hot : any;
        case 3: return number % (cells + cells / 2 + 1);
        case 4: return cells + number % (CELLIST_NONE - cells);
        default: return i % max(cells, 1u);
    }
}

kernel void insert_some(CELLIST_LISTS(Item, lists), uint distribution, uint seed, uint count)
{
    for (uint i = get_global_id(0); i < count; i += get_global_size(0)) {
        Item item = { (float)(scramble(~(seed + i)) >> 8), i };
        cellist_insert(lists, cell_of(distribution, seed, i, cellist_cells(lists)), item);
    }
}
)";

cl_uint scramble(cl_uint x) {
    x = (x ^ (x >> 16)) * 0x7FEB352Du;
    x = (x ^ (x >> 15)) * 0x846CA68Bu;
    return x ^ (x >> 16);
}

cl_uint cell_of(cl_uint distribution, cl_uint seed, cl_uint i, cl_uint cells) {
    const cl_uint number = scramble(seed + i);
    const cl_uint any = number % std::max(cells, 1u);
    const cl_uint hot = seed % std::max(cells, 1u);
    switch (distribution) {
        case uniform:
            return any;
        case one_cell:
            return hot;
        case half_in_one_cell:
            return (number & 0x40000000u) != 0 ? hot : any;
        case partly_outside:
            return number % (cells + cells / 2 + 1);
        case outside:
            return cells + number % (0xFFFFFFFFu - cells);
        default:
            return i % std::max(cells, 1u);
    }
}

/// The records of a case.
struct Input {
    cl_uint distribution;
    cl_uint seed;
    cl_uint count;

    /// How many records go to each cell, and behind the last how many go to none.
    [[nodiscard]] std::vector<std::uint64_t> demands(cl_uint cells) const {
        std::vector<std::uint64_t> result(cells + 1);
        for (cl_uint i = 0; i < count; ++i)
            ++result[std::min(cell_of(distribution, seed, i, cells), cells)];
        return result;
    }
};

/// What the report of a build must say that does not throw.
struct ExpectedReport {
    std::uint64_t demand = 0;  ///< records for cells of the shape
    std::uint64_t longest = 0;
    std::uint64_t rejected = 0;
    std::uint64_t fit = 0;  ///< records that a pool of the options has room for
};

ExpectedReport expect(const std::vector<std::uint64_t>& demands, const ListsOptions& options) {
    ExpectedReport expected;
    for (std::size_t cell = 0; cell + 1 < demands.size(); ++cell) {
        expected.demand += demands[cell];
        expected.longest = std::max(expected.longest, demands[cell]);
        expected.fit += std::min<std::uint64_t>(demands[cell], options.slots.value_or(0));
    }
    expected.rejected = demands.back();
    if (!has_slots(options.storage))
        expected.fit = std::min(expected.demand, options.capacity_nodes.value_or(0));
    return expected;
}

/// Whether each cell holds records that were inserted into it, none twice.
bool is_sub_multiset(const HostLists<Item>& found, const Input& input) {
    std::vector<bool> seen(input.count, false);
    const auto cells = static_cast<cl_uint>(found.cells());
    for (cl_uint cell = 0; cell < cells; ++cell)
        for (const Item& item : found.cell(cell)) {
            if (item.id >= input.count || seen[item.id]) return false;
            if (cell_of(input.distribution, input.seed, item.id, cells) != cell) return false;
            if (item.key != static_cast<cl_float>(scramble(~(input.seed + item.id)) >> 8))
                return false;
            seen[item.id] = true;
        }
    return true;
}

void require_adds_up(const BuildReport& report, const Input& input, std::uint64_t rejected) {
    REQUIRE(report.attempted == input.count);
    REQUIRE(report.attempted == report.stored + report.dropped + report.rejected);
    REQUIRE(report.rejected == rejected);
}

Shape random_shape(std::mt19937& random) {
    const auto extent = [&](std::uint32_t end) {
        return std::uint64_t{below(random, 40) == 0 ? 0 : 1 + below(random, end)};
    };
    switch (below(random, 4)) {
        case 0:
            return {extent(300)};
        case 1:
            return {extent(20), extent(20)};
        case 2:
            return {extent(7), extent(7), extent(7)};
        default:
            return {extent(4), extent(4), extent(4), extent(4)};
    }
}

/// Room for nothing, for one record, for all but one, for all and for any other number.
std::uint64_t random_room(std::uint64_t exact, std::mt19937& random) {
    switch (below(random, 6)) {
        case 0:
            return 0;
        case 1:
            return 1;
        case 2:
            return exact;
        case 3:
            return exact - std::min<std::uint64_t>(exact, 1);
        case 4:
            return exact + 1;
        default:
            return below(random, static_cast<std::uint32_t>(2 * exact + 2));
    }
}

TEST_CASE("every record of random builds is stored, dropped or rejected", "[accounting]") {
    CELLIST_RANDOM(random, 200u);
    const Lists<Item> any(device(), {1});
    Kernel kernel(device(), insert_some_source, "insert_some", any);
    constexpr std::array<std::uint64_t, 5> groups{1, 7, 32, 64, 256};
    constexpr std::array<Overflow, 3> policies{Overflow::grow, Overflow::stop, Overflow::drop};
    constexpr std::array<cl_uint, 5> counts{0, 1, 40, 500, 3000};

    std::array<int, all_storages.size()> by_storage{};
    int thrown = 0;
    int short_of_room = 0;
    for (int i = 0; i < case_count; ++i) {
        const Shape shape = random_shape(random);
        const auto cells = static_cast<cl_uint>(shape.cells());
        const Input input{below(random, distribution_count), static_cast<cl_uint>(random()),
                          below(random, counts[below(random, counts.size())] + 1)};
        const std::vector<std::uint64_t> demands = input.demands(cells);
        ListsOptions options;
        options.storage =
            all_storages[below(random, static_cast<std::uint32_t>(all_storages.size()))];
        options.overflow = policies[below(random, 3)];
        const ExpectedReport exact = expect(demands, options);
        options.capacity_nodes = random_room(exact.demand, random);
        options.slots = static_cast<std::uint32_t>(random_room(exact.longest, random));
        const ExpectedReport expected = expect(demands, options);
        const std::uint64_t group = groups[below(random, groups.size())];
        Range range(group * (1 + below(random, 8)));
        range.local = {group, 1, 1};
        INFO("case " << i << ": " << name_of(options.storage) << ", shape " << shape.to_string()
                     << ", policy " << static_cast<int>(options.overflow) << ", capacity "
                     << *options.capacity_nodes << ", slots " << *options.slots << ", "
                     << input.count << " records of distribution " << input.distribution
                     << ", work-groups of " << group);

        Lists<Item> lists(device(), shape, options);
        const bool fits = expected.fit == expected.demand;
        std::uint64_t stored = 0;
        try {
            const BuildReport report =
                lists.build(kernel, range, input.distribution, input.seed, input.count);
            REQUIRE((fits || options.overflow != Overflow::stop));
            stored = options.overflow == Overflow::drop ? expected.fit : expected.demand;
            require_adds_up(report, input, expected.rejected);
            REQUIRE(report.stored == stored);
            REQUIRE(report.capacity_nodes == lists.capacity_nodes());
        } catch (const OverflowError& error) {
            REQUIRE_FALSE(fits);
            REQUIRE(options.overflow == Overflow::stop);
            require_adds_up(error.report(), input, expected.rejected);
            ++thrown;
        }
        require_sound(lists, stored);
        const HostLists<Item> found = lists.download();
        REQUIRE(found.records().size() == stored);
        REQUIRE(is_sub_multiset(found, input));
        ++by_storage[static_cast<std::size_t>(Storage{options.storage})];
        short_of_room += fits ? 0 : 1;
    }
    std::cout << "accounting: " << case_count << " cases:";
    for (const Storage storage : all_storages)
        std::cout << ' ' << by_storage[static_cast<std::size_t>(storage)] << ' '
                  << name_of(storage);
    std::cout << "; " << short_of_room << " short of room, " << thrown << " of them thrown"
              << std::endl;
    const int share = case_count / (static_cast<int>(all_storages.size()) + 1);
    REQUIRE(*std::min_element(by_storage.begin(), by_storage.end()) > share);
    REQUIRE(thrown > case_count / 20);
}

}  // namespace
}  // namespace cellist::test
