// SPDX-License-Identifier: MIT
// Records are scalars or vectors, without an adapted struct.
#include <functional>

#include "support/internals.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr std::uint64_t cells = 9;

/// Lists of several classes of length, with many ties. No record falls into the last cell.
template <class T>
Inserts<T> scalars(std::mt19937& random, auto&& value) {
    Inserts<T> inserts;
    for (const cl_uint length : {1u, 20u, 100u, 700u})
        for (cl_uint i = 0; i < length; ++i)
            inserts.add(length / 10 % 8, value(below(random, 400)));
    return inserts;
}

template <class T>
T scalar(std::uint32_t value) {
    return static_cast<T>(std::is_signed_v<T> ? static_cast<T>(value) - static_cast<T>(200)
                                              : static_cast<T>(value));
}

template <class T>
void require_lists(const HostLists<T>& found, const Inserts<T>& inserts, auto before) {
    REQUIRE(same_bits(found, sorted_lists(inserts, cells, before)));
}

TEST_CASE("scalars are built, sorted, packed and downloaded") {
    CELLIST_EACH_STORAGE(storage);
    const cl_device_type division =
        GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU});
    // Fixed lists are sorted as counted ones, and one storage is enough for work-groups.
    if (storage != Storage::linked && division == CL_DEVICE_TYPE_GPU) return;
    CELLIST_RANDOM(random, 230u);
    const Inserts<cl_uint> inserts = scalars<cl_uint>(random, scalar<cl_uint>);
    Lists<cl_uint> lists(device(), {cells}, {.storage = storage});
    sort_as_on(lists, division);
    REQUIRE(Inserter(lists).build(lists, inserts).stored == inserts.size());
    REQUIRE(lists.validate().ok());

    lists.sort();
    require_lists(lists.download(), inserts, std::less<cl_uint>());
    lists.sort(Order::descending);
    require_lists(lists.download(), inserts, std::greater<cl_uint>());
    lists.sort_async();
    require_lists(lists.download(), inserts, std::less<cl_uint>());
    lists.sort_by("-(int)record");
    const HostLists<cl_uint> found = lists.download();
    require_lists(found, inserts, std::greater<cl_uint>());
    const Packed<cl_uint> packed = lists.pack();
    REQUIRE(packed.records.download() == found.records());
    REQUIRE(packed.offsets.download().back() == inserts.size());
}

TEMPLATE_TEST_CASE("scalars of any size are sorted", "", cl_uchar, cl_float, cl_long) {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    CELLIST_RANDOM(random, 232u);
    const Inserts<TestType> inserts = scalars<TestType>(random, scalar<TestType>);
    Lists<TestType> lists(device(), {cells}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort();
    require_lists(lists.download(), inserts, std::less<TestType>());
}

TEST_CASE("the first scalars of each list are found and kept") {
    CELLIST_RANDOM(random, 231u);
    const Inserts<cl_float> inserts = scalars<cl_float>(random, scalar<cl_float>);
    const HostLists<cl_float> sorted = sorted_lists(inserts, cells, std::less<cl_float>());
    const bool keeps = GENERATE(false, true);
    Lists<cl_float> lists(
        device(), {cells},
        {.storage = keeps ? nearest<cl_float>(5) : StorageOption(Storage::counted)});
    Inserter(lists).build(lists, inserts);
    lists.partial_sort(5);
    const HostLists<cl_float> found = lists.download();
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
        const auto all = sorted.cell(cell);
        const std::size_t count = std::min<std::size_t>(all.size(), 5);
        REQUIRE(found.cell(cell).size() == (keeps ? count : all.size()));
        for (std::size_t i = 0; i < count; ++i) REQUIRE(found.cell(cell)[i] == all[i]);
    }
    REQUIRE_THROWS_AS((Lists<cl_uint>(device(), {1}, {.storage = nearest<cl_float>(5)})), Error);
}

/// Ids of an even number, of an odd one, and all of them.
constexpr auto ids_source = R"(
kernel void add(CELLIST_LISTS(uint, ids), uint first)
{
    const uint id = first + 2u * (uint)get_global_id(0);
    cellist_insert(ids, id % 5, id);
}
kernel void sums(CELLIST_LISTS(uint, ids), global uint* sums)
{
    uint sum = 0;
    const uint cell = get_global_id(0);
    cellist_for_each(ids, cell, node) {
        const uint id = cellist_get(ids, node);
        cellist_get(ids, node) += 1000;
        sum += id;
    }
    sums[cell] = sum + (cellist_length(ids, cell) << 16);
}
)";

TEST_CASE("kernels insert, read and change ids in every storage", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    Lists<cl_uint> ids(device(), {5}, {.storage = storage});
    Kernel add(device(), ids_source, "add", ids);
    Kernel sum(device(), ids_source, "sums", ids);
    REQUIRE(ids.build(add, 20, 0u).stored == 20);
    const BuildReport report = ids.append(add, 20, 1u);
    REQUIRE((report.stored == 40 && report.existing == 20));
    const Buffer<cl_uint> sums(device(), 5);
    sum.run(5, ids, sums);
    for (cl_uint cell = 0; cell < 5; ++cell)
        REQUIRE(sums.download()[cell] == (8u << 16) + 8 * cell + 5 * 28);

    REQUIRE(ids.remove_if("record % 2 == odd", {{"odd", 1u}}) == 20);
    Lists<cl_uint> both = ids.copy();
    REQUIRE(both.merge(ids).stored == 40);
    both.sort();
    const HostLists<cl_uint> found = both.download();
    for (cl_uint cell = 0; cell < 5; ++cell) {
        REQUIRE(found.cell(cell).size() == 8);
        for (cl_uint i = 0; i < 8; ++i) {
            const cl_uint id = found.cell(cell)[i] - 1000;
            REQUIRE((id % 5 == cell && id % 2 == 0 && id / 10 == i / 2));
        }
    }
}

TEMPLATE_TEST_CASE("vectors are records", "", cl_int2, Vector3<cl_int>) {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    Lists<TestType> lists(device(), {2}, {.storage = storage});
    const std::string type = DeviceType<TestType>::name();
    Kernel insert(device(),
                  "kernel void insert(CELLIST_LISTS(" + type + ", lists)) {\n    const " + type +
                      " v = get_global_id(0) * 7 % 40;\n"
                      "    cellist_insert(lists, 1, v);\n}\n",
                  "insert", lists);
    lists.build(insert, 40);
    lists.sort_by("record.x", Order::descending);
    const std::vector<TestType> found = lists.download().records();
    REQUIRE(found.size() == 40);
    for (cl_int i = 0; i < 40; ++i) {
        std::array<cl_int, 2> components{};
        std::memcpy(components.data(), &found[static_cast<std::size_t>(i)], sizeof components);
        REQUIRE(components == std::array<cl_int, 2>{39 - i, 39 - i});
    }
}

TEST_CASE("halves are records, and one program knows several types of records") {
    Lists<Half> halves(device(), {1});
    Lists<cl_int> ints(device(), {1});
    Lists<Item> items(device(), {1});
    Kernel insert(device(), R"(
kernel void insert(CELLIST_LISTS(cellist_half, halves), CELLIST_LISTS(int, ints),
                   CELLIST_LISTS(Item, items))
{
    const int i = get_global_id(0);
    cellist_insert(halves, 0, cellist_float_to_half(i - 3.5f));
    cellist_insert(ints, 0, i - 4);
    cellist_insert(items, 0, (Item){i, 7});
}
)",
                  "insert", halves, ints, items);
    build([&] { insert.run(8, halves, ints, items); }, halves, ints, items);
    halves.sort();
    ints.sort();
    items.sort(&Item::key);
    for (cl_uint i = 0; i < 8; ++i) {
        REQUIRE(halves.download().cell(0)[i].to_float() == static_cast<float>(i) - 3.5f);
        REQUIRE(ints.download().cell(0)[i] == static_cast<cl_int>(i) - 4);
        REQUIRE(items.download().cell(0)[i] == Item{static_cast<cl_float>(i), 7});
    }
    REQUIRE_THROWS_AS(insert.run(8, halves, items, ints), Error);
}

TEST_CASE("neighbours and nearest take scalars") {
    CELLIST_EACH_STORAGE(storage);
    Lists<cl_float> points(device(), {10}, {.storage = storage});
    Kernel insert(device(), R"(
kernel void insert(CELLIST_LISTS(float, points))
{
    const float x = get_global_id(0) * 0.25f;
    cellist_insert(points, cellist_cell1(points, x), x);
}
)",
                  "insert", points);
    points.build(insert, 40);
    points.sort();
    const Neighbours near = points.neighbours({.distance = "fabs(record - other)", .radius = 0.3f});
    REQUIRE(near.pairs == 2 * 39);
    const Nearest<cl_float> found =
        points.nearest(Buffer<cl_float>(device(), std::vector<cl_float>{5.1f}),
                       {.k = 2, .position = "query", .distance = "fabs(record - query)"});
    REQUIRE(found.records.download() == std::vector<cl_float>{5.0f, 5.25f});
}

}  // namespace
}  // namespace cellist::test
