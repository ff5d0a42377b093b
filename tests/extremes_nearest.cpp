// SPDX-License-Identifier: MIT
// The nearest records by keys at the borders of their types are the first of the sorted lists:
// those that kernels take, and those that nearest() keeps.
#include <iostream>

#include "support/extremes.hpp"
#include "support/skip.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr std::array<cl_uint, 8> nearest_lengths{0, 1, 2, 8, 9, 10, 100, 600};

/// Calls `use(inserts, name, member)` for a key of each type that the device has.
void for_each_key(std::mt19937& random, auto use) {
    const auto numbers = extreme_inserts<Numbers>(nearest_lengths, random);
    use(numbers, "ulong_value", &Numbers::ulong_value);
    use(numbers, "long_value", &Numbers::long_value);
    use(numbers, "float_value", &Numbers::float_value);
    use(numbers, "uint_value", &Numbers::uint_value);
    use(numbers, "int_value", &Numbers::int_value);
    const auto narrow = extreme_inserts<Narrow>(nearest_lengths, random);
    use(narrow, "ushort_value", &Narrow::ushort_value);
    use(narrow, "short_value", &Narrow::short_value);
    use(narrow, "level", &Narrow::level);
    use(narrow, "uchar_value", &Narrow::uchar_value);
    use(narrow, "char_value", &Narrow::char_value);
    if (!device().info().fp64) CELLIST_SKIP("doubles: the device has none");
    use(extreme_inserts<Wide>(nearest_lengths, random), "key", &Wide::key);
}

/// The first records of each list.
template <class T>
HostLists<T> first_of(const HostLists<T>& lists, std::uint64_t count) {
    std::vector<std::uint64_t> offsets{0};
    std::vector<T> records;
    for (std::uint64_t cell = 0; cell < lists.cells(); ++cell) {
        const auto list = lists.cell(cell);
        const auto first = list.first(std::min<std::uint64_t>(list.size(), count));
        records.insert(records.end(), first.begin(), first.end());
        offsets.push_back(records.size());
    }
    return HostLists<T>(lists.shape(), std::move(offsets), std::move(records));
}

template <class T>
Oracle<T> oracle_of(const HostLists<T>& lists) {
    Oracle<T> oracle;
    for (std::uint64_t cell = 0; cell < lists.cells(); ++cell)
        for (const T& record : lists.cell(cell)) oracle.emplace(cell, record);
    return oracle;
}

constexpr auto take_nearest_source = R"(
#include <cellist/lists.clh>

#define LISTS(type) CELLIST_LISTS(type, lists)
#define NEAREST(member) cellist_nearest(lists, cell, member, 9, nearest)

kernel void take_nearest(LISTS(RECORD), global RECORD* out, global uint* found)
{
    const uint cell = get_global_id(0);
    RECORD nearest[9];
    found[cell] = NEAREST(KEY);
    for (uint i = 0; i < found[cell]; ++i) out[cell * 9 + i] = nearest[i];
}
)";

/// The 9 nearest records of each list by a member, taken by a kernel.
template <class T>
HostLists<T> take_nearest(const Lists<T>& lists, const std::string& member) {
    const std::string options = "-DRECORD=" + DeviceType<T>::name() + " -DKEY=" + member;
    Kernel kernel(device(), Source{.text = take_nearest_source, .options = options}, "take_nearest",
                  lists);
    const std::uint64_t cells = lists.shape().cells();
    const Buffer<T> out(device(), cells * 9);
    const Buffer<cl_uint> found(device(), cells);
    kernel.run(cells, lists, out, found);

    const std::vector<T> all = out.download();
    std::vector<std::uint64_t> offsets{0};
    std::vector<T> records;
    for (const cl_uint count : found.download()) {
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(9 * (offsets.size() - 1));
        records.insert(records.end(), begin, begin + count);
        offsets.push_back(records.size());
    }
    return HostLists<T>(lists.shape(), std::move(offsets), std::move(records));
}

/// Requires that the 9 nearest by `key` are taken from lists in a storage.
template <class T>
void require_takes_nearest(const Inserts<T>& inserts, Storage storage, const char* name, auto key) {
    INFO("by " << name << ", storage " << name_of(storage));
    Lists<T> lists(device(), {nearest_lengths.size()}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    const HostLists<T> sorted = sorted_lists(inserts, nearest_lengths.size(), before<T>(key));
    REQUIRE(same_bits(take_nearest(lists, name), first_of(sorted, 9)));
}

/// Requires that the nearest by `key` are kept in each of so many slots.
template <class T>
void require_keeps_nearest(const Inserts<T>& inserts, std::uint32_t slots, const char* name,
                           auto key) {
    INFO("by " << name << ", " << slots << " slots");
    Lists<T> lists(device(), {nearest_lengths.size()}, {.storage = nearest(key, slots)});
    const BuildReport report = Inserter(lists).build(lists, inserts);
    REQUIRE(report.stored + report.dropped == inserts.size());
    require_sound(lists, report.stored);
    const HostLists<T> sorted = sorted_lists(inserts, nearest_lengths.size(), before<T>(key));
    require_same(lists.download(), oracle_of(first_of(sorted, slots)));
}

/// Requires that the 9 nearest by `key` are sorted to the front of lists in a storage.
template <class T>
void require_sorts_nearest(const Inserts<T>& inserts, Storage storage, auto key) {
    INFO("storage " << name_of(storage));
    Lists<T> lists(device(), {nearest_lengths.size()}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.partial_sort(key, 9);
    const HostLists<T> found = lists.download();
    const HostLists<T> sorted = sorted_lists(inserts, nearest_lengths.size(), before<T>(key));
    require_same(found, oracle_of(sorted));
    REQUIRE(same_bits(first_of(found, 9), first_of(sorted, 9)));
}

TEST_CASE("kernels take the nearest records by keys at the borders of their types", "[extremes]") {
    CELLIST_RANDOM(random, 85u);
    std::size_t cases = 0;
    for_each_key(random, [&](const auto& inserts, const char* name, auto key) {
        require_takes_nearest(inserts, all_storages[cases++ % all_storages.size()], name, key);
    });
    std::cout << "extremes: the nearest records were taken in " << cases << " cases" << std::endl;
}

TEST_CASE("the nearest records by keys at the borders of their types are kept", "[extremes]") {
    CELLIST_RANDOM(random, 86u);
    int cases = 0;
    for_each_key(random, [&](const auto& inserts, const char* name, auto key) {
        for (const std::uint32_t slots : {0u, 1u, 9u, 200u, 1000u}) {
            require_keeps_nearest(inserts, slots, name, key);
            ++cases;
        }
    });
    std::cout << "extremes: the nearest records were kept in " << cases << " cases" << std::endl;
}

TEST_CASE("the nearest records by keys at the borders of their types are sorted to the front",
          "[extremes]") {
    CELLIST_RANDOM(random, 88u);
    const auto numbers = extreme_inserts<Numbers>(nearest_lengths, random);
    require_sorts_nearest(numbers, Storage::linked, &Numbers::float_value);
    require_sorts_nearest(numbers, Storage::counted, &Numbers::long_value);
    if (!device().info().fp64) CELLIST_SKIP("doubles: the device has none");
    const auto doubles = extreme_inserts<Wide>(nearest_lengths, random);
    require_sorts_nearest(doubles, Storage::fixed, &Wide::key);
}

TEST_CASE("a member at the borders of its type is packed alone", "[extremes]") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 87u);
    const auto inserts = extreme_inserts<Numbers>(nearest_lengths, random);
    Lists<Numbers> lists(device(), {nearest_lengths.size()}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort(&Numbers::float_value);
    std::vector<cl_float> expected;
    for (const Numbers& record :
         sorted_lists(inserts, nearest_lengths.size(), before<Numbers>(&Numbers::float_value))
             .records())
        expected.push_back(record.float_value);
    REQUIRE(same_bits(lists.pack(&Numbers::float_value).records.download(), expected));
}

}  // namespace
}  // namespace cellist::test
