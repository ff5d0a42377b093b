// SPDX-License-Identifier: MIT
// lengths() describes the lists as the oracle does, and so do the lengths on the device.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// The lengths that the library and a kernel of the user find on the device, their prefix sums, and
/// histograms of few and of many bins.
void check_on_device(const Lists<Item>& lists, const Oracle<Item>& oracle) {
    const std::uint64_t cells = lists.shape().cells();
    std::vector<cl_uint> lengths;
    std::vector<cl_uint> offsets{0};
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
        lengths.push_back(static_cast<cl_uint>(oracle.count(cell)));
        offsets.push_back(offsets.back() + lengths.back());
    }
    REQUIRE(lists.device_lengths().download() == lengths);
    REQUIRE(lists.device_offsets().download() == offsets);
    for (const cl_uint bins : {1u, 5u, 256u, 257u, 5000u}) {
        std::vector<cl_uint> histogram(bins, 0);
        for (const cl_uint length : lengths) ++histogram[std::min(length, bins - 1)];
        REQUIRE(lists.device_histogram(bins).download() == histogram);
    }

    Kernel measure(device(), R"(
#include <cellist/lists.clh>
kernel void measure(CELLIST_LISTS(Item, lists), global uint* lengths)
{
    const uint cell = get_global_id(0);
    lengths[cell] = cellist_length(lists, cell);
    // Node i of a list is the one that a traversal visits as the i-th.
    uint i = 0;
    cellist_for_each(lists, cell, node)
        if (i % 97 > 3 ? (++i, 0) : cellist_node_at(lists, cell, i++) != node)
            lengths[cell] = CELLIST_NONE;
    if (cellist_node_at(lists, cell, i) != CELLIST_NONE ||
        cellist_node_at(lists, cell, CELLIST_NONE) != CELLIST_NONE ||
        cellist_node_at(lists, -1, 0) != CELLIST_NONE)
        lengths[cell] = CELLIST_NONE;
    if (cellist_length(lists, -1) != 0 || cellist_length(lists, cellist_cells(lists)) != 0)
        lengths[cell] = CELLIST_NONE;
}
)",
                   "measure", lists);
    const Buffer<cl_uint> found(device(), cells);
    measure.run(cells, lists, found);
    REQUIRE(found.download() == lengths);
}

void check(Storage storage, const Shape& shape, const Inserts<Item>& inserts) {
    INFO("shape " << shape.to_string() << ", " << inserts.size() << " inserts");
    Lists<Item> lists(device(), shape, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    const Oracle<Item> oracle = oracle_of(inserts, shape.cells());
    std::map<std::uint64_t, std::uint64_t> cells_of_length;
    for (std::uint64_t cell = 0; cell < shape.cells(); ++cell)
        ++cells_of_length[oracle.count(cell)];
    const std::uint64_t longest = cells_of_length.empty() ? 0 : cells_of_length.rbegin()->first;

    const Lengths lengths = lists.lengths();
    REQUIRE(lengths.total == oracle.size());
    REQUIRE(lengths.longest == longest);
    REQUIRE(lengths.nonempty_cells == shape.cells() - cells_of_length[0]);
    std::erase_if(cells_of_length, [](const auto& entry) { return entry.second == 0; });
    REQUIRE(lengths.histogram == cells_of_length);
    check_on_device(lists, oracle);
}

TEST_CASE("the histogram counts the cells of every length") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 120u);
    for (const std::size_t count : {0u, 1u, 7u, 93u, 144u, 4096u}) {
        check(storage, {13, 11}, random_inserts(count, 150, random));
        check(storage, {1}, random_inserts(count, 1, random));
        check(storage, {0}, random_inserts(count, 1, random));
    }
    Inserts<Item> one_long = random_inserts(4096, 1, random);
    for (cl_uint& cell : one_long.cells) cell = 42;
    check(storage, {13, 11}, one_long);
}

TEST_CASE("the nearest records have lengths on the device") {
    CELLIST_RANDOM(random, 121u);
    Lists<Item> lists(device(), {50}, {.storage = nearest(&Item::key, 5)});
    const Inserts<Item> inserts = random_inserts(400, 50, random);
    Inserter(lists).build(lists, inserts);
    Oracle<Item> oracle;
    for (const Item& item : inserts.records) {
        const std::uint64_t cell = inserts.cells[item.id];
        if (oracle.count(cell) < 5) oracle.emplace(cell, item);
    }
    check_on_device(lists, oracle);
}

TEST_CASE("lengths on the device wait for a build that may grow") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 122u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 1, .slots = 1});
    UploadedInserts uploaded(lists, inserts);
    auto pending = uploaded.build_async(lists);
    check_on_device(lists, oracle_of(inserts, 50));
    REQUIRE(pending.get().stored == 4096);
}

TEST_CASE("a histogram without bins is refused") {
    const Lists<Item> lists(device(), {50});
    REQUIRE_THROWS_AS(lists.device_histogram(0), Error);
}

}  // namespace
}  // namespace cellist::test
