// SPDX-License-Identifier: MIT
// Lists are sorted in classes by their length, by one work-item or by many, in one pool or in two.
// The result does not depend on it.
#include <limits>

#include "device/view.hpp"
#include "support/errors.hpp"
#include "support/internals.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Lengths at the borders of all classes, of chunks and of the parts that long lists are walked in.
std::vector<cl_uint> border_lengths() {
    std::vector<cl_uint> lengths{0, 1, 2, 3};
    for (cl_uint length = 8; length <= 1024; length *= 2)
        for (const cl_uint near : {length - 1, length, length + 1}) lengths.push_back(near);
    return lengths;
}

/// Lists of these lengths, whose keys are equal here and there.
Inserts<Item> inserts_of(const std::vector<cl_uint>& lengths, std::mt19937& random) {
    Inserts<Item> inserts;
    for (cl_uint cell = 0; cell < lengths.size(); ++cell)
        for (cl_uint i = 0; i < lengths[cell]; ++i)
            inserts.add(cell, {static_cast<cl_float>(below(random, 2000)) - 1000.0f,
                               static_cast<cl_uint>(inserts.size())});
    inserts.shuffle(random);
    return inserts;
}

/// Divides the work as on either type of device.
#define CELLIST_EACH_DIVISION(lists)                                                               \
    const cl_device_type division =                                                                \
        GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU});          \
    INFO("work is divided as on a " << (division == CL_DEVICE_TYPE_CPU ? "CPU" : "GPU"));          \
    sort_as_on(lists, division)

/// Requires that the first `count` records of each cell are sorted, and the others are all there.
void require_front(const HostLists<Item>& found, const HostLists<Item>& sorted, std::size_t count) {
    REQUIRE(found.offsets() == sorted.offsets());
    // The others follow in any order: that of their ids, which are unique, makes them comparable.
    const auto comparable = [count](auto cell) {
        std::vector<Item> list(cell.begin(), cell.end());
        const auto front = static_cast<std::ptrdiff_t>(std::min(count, list.size()));
        std::sort(list.begin() + front, list.end(), by_id);
        return list;
    };
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
        if (comparable(found.cell(cell)) != comparable(sorted.cell(cell)))
            FAIL("cell " << cell << ", " << found.cell(cell).size() << " records");
}

TEST_CASE("lists at the borders of the classes are sorted") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 170u);
    const std::vector<cl_uint> lengths = border_lengths();
    const Inserts<Item> inserts = inserts_of(lengths, random);
    Lists<Item> lists(device(), {lengths.size()}, {.storage = storage});
    CELLIST_EACH_DIVISION(lists);
    Inserter inserter(lists);
    const Oracle<Item> oracle = oracle_of(inserts, lengths.size());
    for (int i = 0; i < 2; ++i) {
        inserter.build(lists, inserts);
        lists.sort(&Item::key);
        require_sound(lists, inserts.size());
        require_sorted(lists.download(), oracle, by_key);
    }
    lists.sort(&Item::id, Order::descending);
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle,
                   [](const Item& a, const Item& b) { return a.id > b.id; });
}

TEST_CASE("a list of each class is sorted in every way", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 177u);
    const std::vector<cl_uint> lengths{1, 20, 40, 300, 600, 0};
    const Inserts<Item> inserts = inserts_of(lengths, random);
    const Oracle<Item> oracle = oracle_of(inserts, lengths.size());
    Lists<Item> lists(device(), {lengths.size()}, {.storage = storage});
    CELLIST_EACH_DIVISION(lists);
    Inserter inserter(lists);
    inserter.build(lists, inserts);
    lists.partial_sort(&Item::key, 4);
    require_sound(lists, inserts.size());
    require_front(lists.download(), sorted_lists(inserts, lengths.size(), by_key), 4);
    inserter.build(lists, inserts);
    lists.sort(&Item::key);
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle, by_key);
    inserter.build(lists, inserts);
    lists.sort_async(&Item::key).wait();
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle, by_key);
}

TEST_CASE("many short lists and a few long ones are sorted") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 171u);
    std::vector<cl_uint> lengths(3000);
    for (cl_uint& length : lengths) length = below(random, 12);
    for (const cl_uint length : {40u, 200u, 300u, 5000u}) lengths[below(random, 3000)] = length;
    const Inserts<Item> inserts = inserts_of(lengths, random);
    Lists<Item> lists(device(), {60, 50}, {.storage = storage});
    CELLIST_EACH_DIVISION(lists);
    Inserter(lists).build(lists, inserts);
    lists.sort(&Item::key);
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle_of(inserts, 3000), by_key);
}

TEST_CASE("the classes of the last sort do not bind the next") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 172u);
    Lists<Item> lists(device(), {64}, {.storage = storage});
    CELLIST_EACH_DIVISION(lists);
    Inserter inserter(lists);
    for (const cl_uint length : {3u, 600u, 20u, 0u, 130u, 1u}) {
        const Inserts<Item> inserts = inserts_of(std::vector<cl_uint>(64, length), random);
        inserter.build(lists, inserts);
        lists.sort(&Item::key);
        require_sorted(lists.download(), oracle_of(inserts, 64), by_key);
    }
}

TEST_CASE("the first records of lists are sorted alone") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 173u);
    const cl_uint longest = GENERATE(20u, 700u, 3000u, 9000u);
    std::vector<cl_uint> lengths(10);
    for (cl_uint& length : lengths) length = longest - below(random, 10);
    lengths.front() = 3;
    lengths.back() = 0;
    const Inserts<Item> inserts = inserts_of(lengths, random);
    Lists<Item> lists(device(), {lengths.size()}, {.storage = storage});
    CELLIST_EACH_DIVISION(lists);
    Inserter inserter(lists);
    const HostLists<Item> sorted = sorted_lists(inserts, lengths.size(), by_key);
    for (const std::uint32_t count : {0u, 1u, 4u, 8u, 33u, 64u, 65u, 5000u, 0xFFFFFFFFu}) {
        INFO(count << " of " << longest);
        inserter.build(lists, inserts);
        lists.partial_sort(&Item::key, count);
        require_sound(lists, inserts.size());
        require_front(lists.download(), sorted, count);
    }
    lists.partial_sort_by("-(long)record.id", 2);
    const HostLists<Item> found = lists.download();
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
        for (const Item& item : found.cell(cell)) REQUIRE(item.id <= found.cell(cell).front().id);
}

TEST_CASE("lists are sorted where there is no memory for a second pool") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 174u);
    const std::vector<cl_uint> lengths = border_lengths();
    const Inserts<Item> inserts = inserts_of(lengths, random);
    ListsOptions options{.storage = storage};
    const std::uint64_t built = [&] {
        Lists<Item> lists(device(), {lengths.size()}, options);
        Inserter(lists).build(lists, inserts);
        return lists.pool_bytes();
    }();
    options.budget_bytes = built;
    if (storage == Storage::fixed) options.slots = 1025;
    Lists<Item> lists(device(), {lengths.size()}, options);
    CELLIST_EACH_DIVISION(lists);
    Inserter(lists).build(lists, inserts);
    lists.sort(&Item::key);
    REQUIRE(lists.pool_bytes() <= options.budget_bytes);
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle_of(inserts, lengths.size()), by_key);
}

TEST_CASE("the second pool counts, and goes where the pool goes") {
    CELLIST_RANDOM(random, 175u);
    const Inserts<Item> few = inserts_of({500, 500}, random);
    Lists<Item> lists(device(), {2}, {.capacity_nodes = 1000});
    Inserter inserter(lists);
    inserter.build(lists, few);
    const std::uint64_t before = lists.pool_bytes();
    lists.sort(&Item::key);
    // 1,000 nodes of 12 bytes, two heads, and what sorts keep of themselves.
    REQUIRE(lists.pool_bytes() >= before + 12'008);
    REQUIRE(lists.pool_bytes() < before + 12'048 + sizeof(cellist_sort_state));
    inserter.build(lists, inserts_of({1000, 1000}, random));
    REQUIRE(lists.pool_bytes() < before + 12'008 + 12'000);
}

TEST_CASE("lists are sorted without blocking") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 176u);
    const std::vector<cl_uint> lengths = border_lengths();
    const Inserts<Item> inserts = inserts_of(lengths, random);
    Lists<Item> lists(device(), {lengths.size()}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    const Oracle<Item> oracle = oracle_of(inserts, lengths.size());
    lists.sort_async(&Item::key).wait();
    require_sound(lists, inserts.size());
    require_sorted(lists.download(), oracle, by_key);
    lists.sort_by_async("record.id ^ 5", Order::descending);
    require_sorted(lists.download(), oracle,
                   [](const Item& a, const Item& b) { return (a.id ^ 5u) > (b.id ^ 5u); });
}

}  // namespace
}  // namespace cellist::test
