// SPDX-License-Identifier: MIT
// The downloaded lists are addressed by position and by index, and outlive the container.
#include <stdexcept>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/skip.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("positions, indices and offsets address the same lists") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 130u);
    const Inserts<Item> inserts = random_inserts(4096, 4 * 3 * 5, random);
    std::optional<HostLists<Item>> host;
    {
        Lists<Item> lists(device(), {4, 3, 5}, {.storage = storage});
        Inserter(lists).build(lists, inserts);
        host = lists.download();
    }
    REQUIRE(host->shape() == Shape{4, 3, 5});
    REQUIRE(host->cells() == 60);
    REQUIRE(host->offsets().size() == 61);
    REQUIRE(host->offsets().front() == 0);
    REQUIRE(host->offsets().back() == 4096);
    REQUIRE(std::is_sorted(host->offsets().begin(), host->offsets().end()));
    const Oracle<Item> oracle = oracle_of(inserts, 60);
    require_same(*host, oracle);
    for (std::uint64_t z = 0; z < 5; ++z)
        for (std::uint64_t y = 0; y < 3; ++y)
            for (std::uint64_t x = 0; x < 4; ++x) {
                const std::uint64_t cell = (z * 3 + y) * 4 + x;
                const auto list = (*host)[{x, y, z}];
                REQUIRE(list.data() == host->records().data() + host->offsets()[cell]);
                REQUIRE(list.data() == host->cell(cell).data());
                REQUIRE(list.size() == host->cell(cell).size());
                REQUIRE(list.size() == oracle.count(cell));
            }
}

TEST_CASE("a list of a download that is not kept is a copy") {
    CELLIST_RANDOM(random, 131u);
    Lists<Item> lists(device(), {1});
    Inserter(lists).build(lists, random_inserts(144, 1, random));
    lists.sort(&Item::id);
    cl_uint next = 0;
    for (const Item& item : lists.download()[{0}]) REQUIRE(item.id == next++);
    for (const Item& item : lists.download().cell(0)) REQUIRE(item.id == next++ - 144);
    REQUIRE(next == 288);
}

TEST_CASE("positions outside of the shape are errors") {
    const Lists<Item> lists(device(), {4, 3});
    const HostLists<Item> host = lists.download();
    const auto error = error_of([&] { (void)host[{4, 0}]; });
    INFO(error.what());
    REQUIRE(contains(error.what(), "4"));
    REQUIRE(contains(error.what(), "4x3"));
    REQUIRE_THROWS_AS((host[{0, 3}]), Error);
    REQUIRE_THROWS_AS((host[{0, ~std::uint64_t{0}}]), Error);
    REQUIRE_THROWS_AS((host[{0, 0, 0}]), Error);
    REQUIRE_THROWS_AS(host.cell(12), std::exception);
    REQUIRE_THROWS_AS(host.cell(~std::uint64_t{0}), std::exception);
    REQUIRE(host[{3, 2}].empty());
    REQUIRE(host.cell(11).empty());
}

TEST_CASE("a download without cells has no lists") {
    CELLIST_EACH_STORAGE(storage);
    const HostLists<Item> host = Lists<Item>(device(), {0, 7}, {.storage = storage}).download();
    REQUIRE(host.cells() == 0);
    REQUIRE(host.records().empty());
    REQUIRE(host.offsets() == std::vector<std::uint64_t>{0});
    REQUIRE_THROWS_AS((host[{0, 0}]), Error);
    REQUIRE_THROWS_AS(host.cell(0), std::exception);
}

struct Large {
    cl_uint id;
    cl_uint copies[255];
};
CELLIST_STRUCT(Large, id, copies);

TEST_CASE("lists of more than 256 MiB are downloaded whole") {
    if (device().info().global_memory_bytes < std::uint64_t{2} << 30)
        CELLIST_SKIP("the device has less than 2 GiB of memory");
    constexpr cl_uint count = 290'000;
    Lists<Large> lists(device(), {7}, {.capacity_nodes = count});
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void fill(CELLIST_LISTS(Large, lists))
{
    Large large;
    large.id = get_global_id(0);
    for (uint i = 0; i < 255; ++i) large.copies[i] = large.id + i;
    cellist_insert(lists, large.id % 7, large);
}
)",
                  "fill", lists);
    require_complete(lists.build(kernel, count), count);
    const HostLists<Large> host = lists.download();
    REQUIRE(host.records().size() == count);
    std::vector<bool> seen(count, false);
    bool same = true;
    for (std::uint64_t cell = 0; cell < 7; ++cell)
        for (const Large& large : host.cell(cell)) {
            same = same && large.id < count && large.id % 7 == cell && !seen[large.id];
            if (!same) break;
            seen[large.id] = true;
            for (cl_uint i = 0; i < 255; ++i) same = same && large.copies[i] == large.id + i;
        }
    REQUIRE(same);
}

}  // namespace
}  // namespace cellist::test
