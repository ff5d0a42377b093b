// SPDX-License-Identifier: MIT
// Lists of any length are sorted, those at the borders of every power of two too, and a cell that
// every work-item inserts into loses nothing.
#include <iostream>

#include "support/extremes.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// 2^k - 1, 2^k and 2^k + 1 up to 2^13 + 1.
std::vector<cl_uint> borders() {
    std::vector<cl_uint> all;
    for (cl_uint power = 1; power <= 1u << 13; power *= 2)
        for (const cl_uint length : {power - 1, power, power + 1}) all.push_back(length);
    return all;
}

/// Keys of lists: how the i-th of `length` records is ranked.
struct Keys {
    const char* name;
    cl_float (*key)(cl_uint i, cl_uint length, std::mt19937& random);
};
constexpr std::array key_distributions{
    Keys{"random",
         [](cl_uint, cl_uint, std::mt19937& random) { return cl_float(below(random, 1u << 24)); }},
    Keys{"few different",
         [](cl_uint, cl_uint, std::mt19937& random) { return cl_float(below(random, 5)); }},
    Keys{"equal", [](cl_uint, cl_uint, std::mt19937&) { return 2.5f; }},
    Keys{"ascending", [](cl_uint i, cl_uint, std::mt19937&) { return cl_float(i); }},
    Keys{"descending",
         [](cl_uint i, cl_uint length, std::mt19937&) { return cl_float(length - i); }},
    Keys{"extreme",
         [](cl_uint, cl_uint, std::mt19937& random) { return extreme<cl_float>(random); }},
};

/// A list for each length, with records in the order of their ids.
Inserts<Item> inserts_of(std::span<const cl_uint> lengths, const Keys& keys, std::mt19937& random) {
    Inserts<Item> inserts;
    for (cl_uint cell = 0; cell < lengths.size(); ++cell)
        for (cl_uint i = 0; i < lengths[cell]; ++i)
            inserts.add(cell,
                        {keys.key(i, lengths[cell], random), static_cast<cl_uint>(inserts.size())});
    return inserts;
}

/// Requires that the lists are sorted in each order of each storage.
void require_sorts(const Inserts<Item>& inserts, std::uint64_t cells, auto member,
                   std::span<const Order> orders, std::span<const Storage> storages) {
    std::vector<Lists<Item>> all;
    for (const Storage storage : storages) {
        Lists<Item>& lists =
            all.emplace_back(device(), Shape{cells}, ListsOptions{.storage = storage});
        require_complete(Inserter(lists).build(lists, inserts), inserts.size());
    }
    for (const Order order : orders) {
        const HostLists<Item> expected = sorted_lists(inserts, cells, before<Item>(member, order));
        for (Lists<Item>& lists : all) {
            INFO(name_of(order) << ", storage " << name_of(lists.storage()));
            lists.sort(member, order);
            require_sound(lists, inserts.size());
            REQUIRE(same_bits(lists.download(), expected));
        }
    }
}

TEST_CASE("lists at the borders of every power of two are sorted", "[extremes]") {
    CELLIST_RANDOM(random, 310u);
    const std::vector<cl_uint> lengths = borders();
    for (const Keys& keys : key_distributions) {
        INFO(keys.name << " keys");
        require_sorts(inserts_of(lengths, keys, random), lengths.size(), &Item::key, all_orders,
                      all_storages);
    }
    std::cout << "extremes: lists of " << lengths.size() << " lengths sorted by "
              << key_distributions.size() << " kinds of keys, in 3 storages and 2 orders"
              << std::endl;
}

TEST_CASE("neighbours of any lengths are sorted", "[extremes]") {
    CELLIST_RANDOM(random, 311u);
    const std::vector<cl_uint> all = borders();
    std::vector<cl_uint> lengths(500);
    // A quarter are empty, and most of the others have up to 2^6 + 1 nodes.
    for (cl_uint& length : lengths) {
        const auto end = static_cast<cl_uint>(below(random, 4) == 0 ? all.size() : 21);
        length = below(random, 4) == 0 ? 0 : all[below(random, end)];
    }
    Inserts<Item> inserts = inserts_of(lengths, key_distributions[0], random);
    inserts.shuffle(random);
    require_sorts(inserts, lengths.size(), &Item::key, all_orders, all_storages);
    std::cout << "extremes: " << lengths.size() << " lists of mixed lengths, " << inserts.size()
              << " records, sorted in 3 storages and 2 orders" << std::endl;
}

TEST_CASE("lists of 100,000 nodes are sorted", "[extremes]") {
    CELLIST_RANDOM(random, 312u);
    const std::vector<cl_uint> lengths{0, 1, 100'000, 2, 100'000, 0};
    for (const Keys& keys : key_distributions) {
        INFO(keys.name << " keys");
        require_sorts(inserts_of(lengths, keys, random), lengths.size(), &Item::key, all_orders,
                      all_storages);
    }
    std::cout << "extremes: lists of 100000 nodes sorted by " << key_distributions.size()
              << " kinds of keys, in 3 storages and 2 orders" << std::endl;
}

TEST_CASE("lists of 100,000 nodes are sorted by one work-item each", "[extremes]") {
    CELLIST_RANDOM(random, 314u);
    const std::vector<cl_uint> lengths{0, 1, 100'000, 2, 100'000, 0};
    const Inserts<Item> inserts = inserts_of(lengths, key_distributions.back(), random);
    const HostLists<Item> expected =
        sorted_lists(inserts, lengths.size(), before<Item>(&Item::key, Order::descending));
    for (const Storage storage : all_storages) {
        INFO("storage " << name_of(storage));
        Lists<Item> lists(device(), {lengths.size()}, {.storage = storage});
        Inserter(lists).build(lists, inserts);
        lists.sort_async(&Item::key, Order::descending);
        REQUIRE(same_bits(lists.download(), expected));
    }
}

TEST_CASE("one list of all 4,194,304 nodes is sorted", "[extremes]") {
    CELLIST_RANDOM(random, 313u);
    constexpr std::array storages{Storage::linked, Storage::counted};
    const std::vector<cl_uint> lengths{0, 1u << 22, 0};
    Inserts<Item> inserts = inserts_of(lengths, key_distributions.back(), random);
    require_sorts(inserts, lengths.size(), &Item::key, std::array{Order::ascending}, storages);
    inserts.shuffle(random);
    require_sorts(inserts, lengths.size(), &Item::id, std::array{Order::descending}, storages);
    std::cout << "extremes: a list of " << inserts.size() << " nodes sorted by 2 keys in 2 storages"
              << std::endl;
}

// ---- a hot cell --------------------------------------------------------------------------------

constexpr cl_uint inserting = 1u << 20;

constexpr auto hot_source = R"(
#include <cellist/lists.clh>

// Work-item i inserts the record { i % 1000, i } into cell 1.
kernel void insert_hot(CELLIST_LISTS(Item, lists))
{
    const uint i = get_global_id(0);
    Item item = { (float)(i % 1000), i };
    cellist_insert(lists, 1, item);
}

kernel void nearest_of_hot(CELLIST_LISTS(Item, lists), global uint* ids)
{
    Item nearest[9];
    const uint found = cellist_nearest(lists, 1, key, 9, nearest);
    for (uint i = 0; i < found; ++i) ids[i] = nearest[i].id;
}
)";

void require_hot_cell(const ListsOptions& options) {
    INFO("storage " << name_of(options.storage));
    Lists<Item> lists(device(), {3}, options);
    Kernel insert(device(), hot_source, "insert_hot", lists);
    require_complete(lists.build(insert, inserting), inserting);
    require_sound(lists, inserting);

    Kernel nearest(device(), hot_source, "nearest_of_hot", lists);
    const Buffer<cl_uint> ids(device(), 9);
    nearest.run(1, lists, ids);
    REQUIRE(ids.download() ==
            std::vector<cl_uint>{0, 1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000});

    lists.sort(&Item::id);
    const HostLists<Item> found = lists.download();
    REQUIRE(found.offsets() == std::vector<std::uint64_t>{0, 0, inserting, inserting});
    for (cl_uint i = 0; i < inserting; ++i)
        if (found.records()[i] != Item{static_cast<cl_float>(i % 1000), i})
            FAIL("record " << i << " is another");
}

TEST_CASE("every work-item inserts into the same cell", "[extremes]") {
    require_hot_cell({});
    require_hot_cell({.storage = Storage::counted});
    require_hot_cell({.storage = Storage::fixed});
    std::cout << "extremes: a cell that " << inserting << " work-items insert into, in 5 ways"
              << std::endl;
}

TEST_CASE("the nearest of what every work-item inserts into the same cell are kept", "[extremes]") {
    Lists<Item> lists(device(), {3}, {.storage = nearest(&Item::key, 3)});
    Kernel insert(device(), hot_source, "insert_hot", lists);
    const BuildReport report = lists.build(insert, inserting);
    REQUIRE(report.stored == 3);
    REQUIRE(report.dropped == inserting - 3);
    require_same(lists.download(), Oracle<Item>{{1, {0, 0}}, {1, {0, 1000}}, {1, {0, 2000}}});
}

}  // namespace
}  // namespace cellist::test
