// SPDX-License-Identifier: MIT
// Storage::counted in one pass on GPUs: records go to regions of the cells' partitions, and the
// library moves them. The device of this test counts as a GPU, whatever it is.
#include "support/inserts.hpp"
#include "support/internals.hpp"

namespace cellist::test {
namespace {

struct OneWord {
    cl_uint id;
};
CELLIST_STRUCT(OneWord, id);

// A size that is no multiple of 4 bytes.
struct Halves {
    cl_ushort a;
    cl_ushort b;
    cl_ushort c;
};
CELLIST_STRUCT(Halves, a, b, c);

struct TenWords {
    cl_float color[9];
    cl_uint id;
};
CELLIST_STRUCT(TenWords, color, id);

Item region_record(cl_uint id, const Item*) { return {static_cast<cl_float>(id % 97), id}; }
OneWord region_record(cl_uint id, const OneWord*) { return {id}; }
Halves region_record(cl_uint id, const Halves*) {
    return {static_cast<cl_ushort>(id), static_cast<cl_ushort>(id >> 16), 7};
}
TenWords region_record(cl_uint id, const TenWords*) { return {{1, 2, 3, 4, 5, 6, 7, 8, 9}, id}; }

constexpr std::uint32_t region_records = 70'000;

/// Records for any cells, `modulus` of them in all.
template <class T>
Inserts<T> spread_over(std::uint32_t cells, std::mt19937& random,
                       std::uint32_t records = region_records) {
    Inserts<T> inserts;
    for (std::uint32_t i = 0; i < records; ++i)
        inserts.add(below(random, cells), region_record(i, static_cast<const T*>(nullptr)));
    inserts.add(cells, inserts.records[0]);
    return inserts;
}

template <class T>
void build_and_check(Lists<T>& lists, const Device& on, const Inserts<T>& inserts,
                     std::uint32_t passes) {
    const Oracle<T> oracle = oracle_of(inserts, lists.shape().cells());
    const BuildReport report = Inserter<T>(lists, on).build(lists, inserts);
    require_complete(report, oracle.size(), inserts.size() - oracle.size());
    CHECK(report.passes == passes);
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
}

template <class T>
void build_in_regions(std::uint32_t cells) {
    INFO(cells << " cells, records of " << sizeof(T) << " bytes");
    CELLIST_RANDOM(random, 950u);
    const Device gpu = like_gpu();
    Lists<T> lists(gpu, {cells}, {.storage = Storage::counted});
    build_and_check(lists, gpu, spread_over<T>(cells, random), 2);
    build_and_check(lists, gpu, spread_over<T>(cells, random), 1);
    build_and_check(lists, gpu, spread_over<T>(cells, random), 1);
}

TEST_CASE("regions hold records of every size, in every number of cells") {
    for (const std::uint32_t cells : {60u, 1000u, 4096u, 30'001u}) build_in_regions<Item>(cells);
    build_in_regions<OneWord>(5000);
    build_in_regions<Halves>(5000);
    build_in_regions<TenWords>(5000);
}

TEST_CASE("the first build has regions of one size where the capacity is known") {
    CELLIST_RANDOM(random, 951u);
    const Device gpu = like_gpu();
    Lists<Item> lists(gpu, {5000}, {.storage = Storage::counted, .capacity_nodes = region_records});
    build_and_check(lists, gpu, spread_over<Item>(5000, random), 1);
    // Few records, then none, then many again.
    build_and_check(lists, gpu, spread_over<Item>(5000, random, 10), 1);
    build_and_check(lists, gpu, Inserts<Item>{}, 1);
    build_and_check(lists, gpu, spread_over<Item>(5000, random), 1);
}

TEST_CASE("a build that finds a region full counts, and the next has other regions") {
    CELLIST_RANDOM(random, 952u);
    const Device gpu = like_gpu();
    Lists<Item> lists(gpu, {5000}, {.storage = Storage::counted});
    const Inserts<Item> all = spread_over<Item>(5000, random);
    Inserts<Item> half;
    for (std::uint32_t i = 0; i < all.size(); ++i) half.add(all.cells[i] / 2, all.records[i]);
    build_and_check(lists, gpu, all, 2);
    build_and_check(lists, gpu, all, 1);
    build_and_check(lists, gpu, half, 3);
    build_and_check(lists, gpu, half, 1);
    build_and_check(lists, gpu, all, 3);
    build_and_check(lists, gpu, all, 1);
}

TEST_CASE("partitions that are too large for a work-group are counted in every build") {
    CELLIST_RANDOM(random, 953u);
    const Device gpu = like_gpu();
    Lists<Item> lists(gpu, {5000}, {.storage = Storage::counted});
    Inserts<Item> hot = spread_over<Item>(5000, random);
    for (std::uint32_t i = 0; i < 2 * region_records; ++i)
        hot.add(77, region_record(i, static_cast<const Item*>(nullptr)));
    build_and_check(lists, gpu, hot, 2);
    build_and_check(lists, gpu, hot, 3);
    build_and_check(lists, gpu, hot, 3);
    build_and_check(lists, gpu, hot, 2);
    build_and_check(lists, gpu, hot, 2);
}

TEST_CASE("more records than the pool has room for make it grow once") {
    CELLIST_RANDOM(random, 954u);
    const Device gpu = like_gpu();
    Lists<Item> lists(gpu, {5000}, {.storage = Storage::counted});
    build_and_check(lists, gpu, spread_over<Item>(5000, random), 2);
    // The regions have room for a part more.
    build_and_check(lists, gpu,
                    spread_over<Item>(5000, random, region_records + region_records / 12), 1);
    const Inserts<Item> many = spread_over<Item>(5000, random, 3 * region_records);
    const Oracle<Item> oracle = oracle_of(many, 5000);
    require_complete(Inserter<Item>(lists, gpu).build(lists, many), oracle.size(), 1);
    require_same(lists.download(), oracle);
    build_and_check(lists, gpu, many, 1);
}

TEST_CASE("a budget without room for regions lets builds count") {
    CELLIST_RANDOM(random, 955u);
    const Device gpu = like_gpu();
    Lists<Item> lists(
        gpu, {5000},
        {.storage = Storage::counted, .budget_bytes = std::uint64_t{region_records} * 16});
    build_and_check(lists, gpu, spread_over<Item>(5000, random), 2);
    build_and_check(lists, gpu, spread_over<Item>(5000, random), 2);
}

}  // namespace
}  // namespace cellist::test
