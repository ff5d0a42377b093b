// SPDX-License-Identifier: MIT
// cellist_hash_cell2 and 3 give positions of any size a cell.
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// A record that keeps its position.
struct Far {
    cl_int x, y, z;
    cl_uint id;
};
CELLIST_STRUCT(Far, x, y, z, id);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void insert_far(CELLIST_LISTS(Far, lists), global const Far* records)
{
    const Far r = records[get_global_id(0)];
    cellist_insert(lists, cellist_hash_cell3(lists, r.x, r.y, r.z), r);
}

kernel void insert_floats(CELLIST_LISTS(Far, lists), global const float* coordinates)
{
    const float x = coordinates[get_global_id(0)];
    const Far r = {0, 0, 0, get_global_id(0)};
    cellist_insert(lists, cellist_hash_cell3(lists, x, 0, 0), r);
    cellist_insert(lists, cellist_hash_cell3(lists, 0, x, 0), r);
    cellist_insert(lists, cellist_hash_cell3(lists, 0, 0, x), r);
    cellist_insert(lists, cellist_hash_cell2(lists, x, 0), r);
    cellist_insert(lists, cellist_hash_cell2(lists, 0, x), r);
}

// The sum of the ids at the same position, and how many there are.
kernel void find_far(CELLIST_LISTS(Far, lists), global const Far* records, global uint2* found)
{
    const Far r = records[get_global_id(0)];
    uint2 sums = 0;
    cellist_for_each(lists, cellist_hash_cell3(lists, r.x, r.y, r.z), node) {
        const Far other = cellist_get(lists, node);
        if (other.x != r.x || other.y != r.y || other.z != r.z) continue;
        sums += (uint2)(1, other.id);
    }
    found[get_global_id(0)] = sums;
}

// The cells of a block around a position.
kernel void cells_of_block(CELLIST_LISTS(Far, lists), int x, int y, int z, int extent,
                           global uint* cells)
{
    const int i = get_global_id(0);
    cells[i] = cellist_hash_cell3(lists, x + i % extent, y + i / extent % extent,
                                  z + i / extent / extent);
}
)";

TEST_CASE("records are found by their position, however far away it is") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 460u);
    const auto far = [&] {
        const cl_int any[] = {0,
                              1,
                              -1,
                              std::numeric_limits<cl_int>::max(),
                              std::numeric_limits<cl_int>::min() + 1,
                              static_cast<cl_int>(random()),
                              static_cast<cl_int>(below(random, 100)) - 50};
        const cl_int value = any[below(random, 7)];
        return value == std::numeric_limits<cl_int>::min() ? 0 : value;
    };
    for (const std::uint64_t cells : {1u, 7u, 93u, 4096u}) {
        std::vector<Far> records;
        std::map<std::tuple<cl_int, cl_int, cl_int>, std::pair<cl_uint, cl_uint>> expected;
        for (cl_uint id = 0; id < 4096; ++id) {
            records.push_back({far(), far(), far(), id});
            const Far& r = records.back();
            auto& [count, sum] = expected[{r.x, r.y, r.z}];
            ++count;
            sum += id;
        }
        Lists<Far> lists(device(), {cells}, {.storage = storage});
        Kernel insert(device(), source, "insert_far", lists);
        const Buffer<Far> uploaded(device(), records);
        require_complete(lists.build(insert, records.size(), uploaded), records.size());
        const Buffer<cl_uint2> found(device(), records.size());
        Kernel find(device(), source, "find_far", lists);
        find.run(records.size(), lists, uploaded, found);
        const std::vector<cl_uint2> sums = found.download();
        for (std::size_t i = 0; i < records.size(); ++i) {
            const auto [count, sum] = expected[{records[i].x, records[i].y, records[i].z}];
            REQUIRE(sums[i].s[0] == count);
            REQUIRE(sums[i].s[1] == sum);
        }
    }
}

TEST_CASE("positions without integer coordinates have no cell") {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> bad{std::nanf(""), infinity,       -infinity,
                                 2147483648.0f, -2147483904.0f, 1e30f};
    const std::vector<float> good{0, -0.5f, 1e-30f, 2147483520.0f, -2147483520.0f, -1e9f};
    Lists<Far> lists(device(), {93});
    Kernel insert(device(), source, "insert_floats", lists);
    const BuildReport refused = lists.build(insert, bad.size(), Buffer<cl_float>(device(), bad));
    require_complete(refused, 0, 5 * bad.size());
    require_complete(lists.build(insert, good.size(), Buffer<cl_float>(device(), good)),
                     5 * good.size());
    Lists<Far> none(device(), {0});
    require_complete(none.build(insert, good.size(), Buffer<cl_float>(device(), good)), 0,
                     5 * good.size());
}

std::vector<cl_uint> cells_of_block(const Lists<Far>& lists, const std::array<cl_int, 3>& first,
                                    cl_int extent) {
    const auto count = static_cast<std::size_t>(extent * extent * extent);
    const Buffer<cl_uint> cells(device(), count);
    Kernel kernel(device(), source, "cells_of_block", lists);
    kernel.run(count, lists, first[0], first[1], first[2], extent, cells);
    return cells.download();
}

TEST_CASE("the cells around a position are all different") {
    CELLIST_RANDOM(random, 461u);
    for (const std::uint64_t cells :
         {50u, 51u, 64u, 93u, 144u, 339u, 340u, 341u, 1000u, 4096u, 65'537u, 1'000'000u})
        for (int again = 0; again < 20; ++again) {
            const Lists<Far> lists(device(), {cells}, {.capacity_nodes = 0});
            const std::array<cl_int, 3> first{
                static_cast<cl_int>(below(random, 1u << 31)) - (1 << 30),
                static_cast<cl_int>(below(random, 1u << 31)) - (1 << 30),
                static_cast<cl_int>(below(random, 1u << 31)) - (1 << 30)};
            INFO(cells << " cells, from " << first[0] << ", " << first[1] << ", " << first[2]);
            const auto distinct = [&](cl_int extent) {
                const std::vector<cl_uint> all = cells_of_block(lists, first, extent);
                REQUIRE(*std::max_element(all.begin(), all.end()) < cells);
                return std::set<cl_uint>(all.begin(), all.end()).size() == all.size();
            };
            REQUIRE(distinct(3));
            if (cells >= 340) REQUIRE(distinct(5));
        }
}

TEST_CASE("boxes of any proportions spread evenly") {
    constexpr std::uint64_t cells = 65'536;
    const Lists<Far> shape(device(), {cells}, {.capacity_nodes = 0});
    Lists<Far> lists(device(), {cells});
    Kernel insert(device(), source, "insert_far", lists);
    const std::array<std::array<cl_int, 3>, 7> boxes{{{32, 32, 32},
                                                      {128, 128, 2},
                                                      {2, 128, 128},
                                                      {8192, 2, 2},
                                                      {2, 8192, 2},
                                                      {2, 2, 8192},
                                                      {1, 32'768, 1}}};
    for (const auto& [width, height, depth] : boxes) {
        INFO(width << " x " << height << " x " << depth);
        std::vector<Far> records;
        for (cl_int z = 0; z < depth; ++z)
            for (cl_int y = 0; y < height; ++y)
                for (cl_int x = 0; x < width; ++x) records.push_back({x - 5, y - 7, z - 1000, 0});
        lists.build(insert, records.size(), Buffer<Far>(device(), records));
        // Half as many positions as cells: a random hash has lists of 8.
        REQUIRE(lists.lengths().longest <= 4);
    }
}

}  // namespace
}  // namespace cellist::test
