// SPDX-License-Identifier: MIT
// The K nearest records of a cell are those that a full sort puts first, for any order of
// insertion.
#include <tuple>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// The member is part of a name in the library, so it cannot be a macro.
std::string nearest_source(const std::string& key) {
    return R"(
#include <cellist/lists.clh>
kernel void nearest(CELLIST_LISTS(Item, lists), global Item* out, global uint* found)
{
    const uint cell = get_global_id(0);
    if (cell > cellist_cells(lists)) return;   // one cell more than there are
    Item records[K + 1];
    records[K].id = 4711;
    found[cell] = cellist_nearest(lists, cell, )" +
           key + R"(, K, records);
    for (uint i = 0; i < found[cell]; ++i) out[cell * K + i] = records[i];
    if (records[K].id != 4711) found[cell] = 0xDEAD;
}
)";
}

using Before = bool (*)(const Item&, const Item&);

/// Requires the K nearest of each cell, and none of a cell outside of the shape.
void require_nearest(const Lists<Item>& lists, const Inserts<Item>& inserts, cl_uint k,
                     const std::string& key, Before before) {
    INFO(k << " nearest by " << key);
    const std::uint64_t cells = lists.shape().cells();
    Kernel kernel(device(),
                  Source{.text = nearest_source(key), .options = "-DK=" + std::to_string(k)},
                  "nearest", lists);
    const Buffer<Item> device_out(device(), (cells + 1) * k);
    const Buffer<cl_uint> device_found(device(), cells + 1);
    kernel.run(cells + 1, lists, device_out, device_found);
    const std::vector<Item> out = device_out.download();
    const std::vector<cl_uint> found = device_found.download();
    REQUIRE(found[cells] == 0);

    const Oracle<Item> oracle = oracle_of(inserts, cells);
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
        std::vector<Item> expected;
        const auto [begin, end] = oracle.equal_range(cell);
        for (auto entry = begin; entry != end; ++entry) expected.push_back(entry->second);
        std::sort(expected.begin(), expected.end(), before);
        expected.resize(std::min<std::size_t>(expected.size(), k));
        INFO("cell " << cell);
        REQUIRE(found[cell] == expected.size());
        REQUIRE(std::equal(expected.begin(), expected.end(),
                           out.begin() + static_cast<std::ptrdiff_t>(cell * k)));
    }
}

TEST_CASE("the nearest K are the first K of the sorted list, whatever the order of insertion") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 110u);
    constexpr cl_uint cells = 20;
    Inserts<Item> inserts = random_inserts(300, cells - 1, random);
    for (Item& item : inserts.records)
        if (item.id % 2 == 0) item.key = static_cast<cl_float>(item.id % 3);
    inserts.add(cells - 2, {-1e30f, 300});
    // What depends on K is the same for all storages.
    const bool all = storage == Storage::linked;
    const std::vector<cl_uint> lengths =
        all ? std::vector<cl_uint>{1, 3, 8, 40} : std::vector<cl_uint>{3};
    Lists<Item> lists(device(), {cells}, {.storage = storage});
    Inserter inserter(lists);
    for (int permutation = 0; permutation < 6; ++permutation) {
        INFO("permutation " << permutation);
        inserter.build(lists, inserts);
        for (const cl_uint k : lengths) {
            require_nearest(lists, inserts, k, "key", [](const Item& a, const Item& b) {
                return std::tie(a.key, a.id) < std::tie(b.key, b.id);
            });
            require_nearest(lists, inserts, k, "id",
                            [](const Item& a, const Item& b) { return a.id < b.id; });
        }
        if (all)
            require_nearest(lists, inserts, 0, "key",
                            [](const Item&, const Item&) { return false; });
        inserts.shuffle(random);
    }
}

TEST_CASE("the nearest K are found in ascending and descending lists") {
    CELLIST_EACH_STORAGE(storage);
    for (const bool ascending : {true, false}) {
        Inserts<Item> inserts;
        for (cl_uint i = 0; i < 1000; ++i)
            inserts.add(0, {static_cast<cl_float>(ascending ? i : 1000 - i), i});
        Lists<Item> lists(device(), {1}, {.storage = storage});
        Inserter(lists).build(lists, inserts);
        // Sorted, the list is walked in exactly this order.
        lists.sort_by(ascending ? "record.id" : "-(int)record.id");
        require_nearest(lists, inserts, 8, "key", [](const Item& a, const Item& b) {
            return std::tie(a.key, a.id) < std::tie(b.key, b.id);
        });
    }
}

}  // namespace
}  // namespace cellist::test
