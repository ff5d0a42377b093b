// Every scalar type is a key, and ties are ordered by the remaining members in their order.
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

enum class Level : cl_short { low = -300, none = 0, high = 300 };

struct Numbers {
    cl_ulong ulong_value;
    cl_long long_value;
    cl_float float_value;
    cl_uint uint_value;
    cl_int int_value;
    cl_ushort ushort_value;
    cl_short short_value;
    Level level;
    cl_uchar uchar_value;
    cl_char char_value;
    friend auto operator<=>(const Numbers&, const Numbers&) = default;
};
CELLIST_STRUCT(Numbers, ulong_value, long_value, float_value, uint_value, int_value, ushort_value,
               short_value, level, uchar_value, char_value);

/// Often one of the extremes or a small number, so that there are ties.
template <class T>
T number(std::mt19937& random) {
    switch (below(random, 6)) {
        case 0:
            return std::numeric_limits<T>::lowest();
        case 1:
            return std::numeric_limits<T>::max();
        case 2:
            return static_cast<T>(static_cast<T>(0) - static_cast<T>(1));
        case 3:
            return static_cast<T>(std::uint64_t{random()} << 32 | random());
        default:
            return static_cast<T>(below(random, 3));
    }
}

TEST_CASE("lists are sorted by members of every scalar type") {
    CELLIST_RANDOM(random, 80u);
    constexpr Level levels[] = {Level::low, Level::none, Level::high};
    Inserts<Numbers> inserts;
    for (int i = 0; i < 2000; ++i)
        inserts.add(below(random, 7),
                    {number<cl_ulong>(random), number<cl_long>(random), number<cl_float>(random),
                     number<cl_uint>(random), number<cl_int>(random), number<cl_ushort>(random),
                     number<cl_short>(random), levels[below(random, 3)], number<cl_uchar>(random),
                     number<cl_char>(random)});
    Lists<Numbers> lists(device(), {7});
    Inserter(lists).build(lists, inserts);

    const auto check = [&](const char* name, auto member) {
        INFO(name);
        lists.sort(member);
        const HostLists<Numbers> found = lists.download();
        const Oracle<Numbers> oracle = oracle_of(inserts, 7);
        for (std::uint64_t cell = 0; cell < 7; ++cell) {
            std::vector<Numbers> expected;
            const auto [begin, end] = oracle.equal_range(cell);
            for (auto entry = begin; entry != end; ++entry) expected.push_back(entry->second);
            std::sort(expected.begin(), expected.end(), [&](const Numbers& a, const Numbers& b) {
                return a.*member != b.*member ? a.*member < b.*member : a < b;
            });
            const auto list = found.cell(cell);
            REQUIRE(std::equal(list.begin(), list.end(), expected.begin(), expected.end()));
        }
    };
    check("ulong", &Numbers::ulong_value);
    check("long", &Numbers::long_value);
    check("float", &Numbers::float_value);
    check("uint", &Numbers::uint_value);
    check("int", &Numbers::int_value);
    check("ushort", &Numbers::ushort_value);
    check("short", &Numbers::short_value);
    check("enum", &Numbers::level);
    check("uchar", &Numbers::uchar_value);
    check("char", &Numbers::char_value);
}

struct Nested {
    Item item;
    cl_short2 pair;
    cl_uchar bytes[2][2];
};
CELLIST_STRUCT(Nested, item, pair, bytes);

TEST_CASE("ties are ordered by the scalars of vectors, arrays and nested structs") {
    CELLIST_RANDOM(random, 81u);
    Inserts<Nested> inserts;
    for (int i = 0; i < 3000; ++i) {
        Nested nested{};
        nested.item = {static_cast<cl_float>(below(random, 2)), below(random, 2)};
        nested.pair = {{static_cast<cl_short>(below(random, 3) - 1),
                        static_cast<cl_short>(below(random, 3) - 1)}};
        for (auto& row : nested.bytes)
            for (cl_uchar& byte : row) byte = static_cast<cl_uchar>(below(random, 3) * 100);
        inserts.add(below(random, 3), nested);
    }
    Lists<Nested> lists(device(), {3});
    Inserter(lists).build(lists, inserts);
    lists.sort_by("record.bytes[1][0]");
    const auto values = [](const Nested& nested) {
        return std::tuple(nested.bytes[1][0], nested.item.key, nested.item.id, nested.pair.s[0],
                          nested.pair.s[1], nested.bytes[0][0], nested.bytes[0][1],
                          nested.bytes[1][0], nested.bytes[1][1]);
    };
    const HostLists<Nested> found = lists.download();
    require_same(found, oracle_of(inserts, 3));
    for (std::uint64_t cell = 0; cell < 3; ++cell) {
        const auto list = found.cell(cell);
        REQUIRE(std::is_sorted(list.begin(), list.end(), [&](const Nested& a, const Nested& b) {
            return values(a) < values(b);
        }));
    }
}

/// Where a value stands in -inf < ... < -0 < +0 < ... < +inf < NaN, for values that are not NaN.
template <class F>
auto place(F value) {
    return std::tuple(value, !std::signbit(value));
}

/// Requires -inf < ... < -0 < +0 < ... < +inf < NaN; equal bits by id.
template <class T, class Bits>
void require_float_order(std::span<const T> list) {
    const auto bits = [](const T& record) { return std::bit_cast<Bits>(record.key); };
    for (std::size_t i = 1; i < list.size(); ++i) {
        const T& a = list[i - 1];
        const T& b = list[i];
        INFO("record " << i << ": " << a.key << " before " << b.key);
        if (bits(a) == bits(b))
            REQUIRE(a.id < b.id);
        else if (std::isnan(a.key))
            REQUIRE(std::isnan(b.key));
        else if (!std::isnan(b.key))
            REQUIRE(place(a.key) < place(b.key));
    }
    // Each value, the NaNs too, stands in one place.
    for (std::size_t i = 0; i < list.size(); ++i)
        for (std::size_t j = i + 1; j < list.size(); ++j)
            if (bits(list[i]) == bits(list[j])) REQUIRE(bits(list[j - 1]) == bits(list[j]));
}

TEST_CASE("floats are ordered from -inf to +inf, -0 before +0, NaN last") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 82u);
    const std::vector<cl_uint> bits{
        0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x00000002, 0x007FFFFF, 0x807FFFFF,
        0x00800000, 0x80800000, 0x3F800000, 0xBF800000, 0x3F800001, 0x7F7FFFFF, 0xFF7FFFFF,
        0x7F800000, 0xFF800000, 0x7FC00000, 0xFFC00000, 0x7FFFFFFF, 0xFFFFFFFF, 0x7FC00001};
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 400; ++i)
        inserts.add(
            i % 2,
            {std::bit_cast<cl_float>(bits[below(random, static_cast<cl_uint>(bits.size()))]), i});
    Lists<Item> lists(device(), {2}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort(&Item::key);
    const HostLists<Item> found = lists.download();
    require_same(found, oracle_of(inserts, 2));
    for (std::uint64_t cell = 0; cell < 2; ++cell)
        require_float_order<Item, cl_uint>(found.cell(cell));
}

struct Wide {
    cl_double key;
    cl_ulong id;
};
CELLIST_STRUCT(Wide, key, id);

TEST_CASE("doubles are ordered as floats are, where the device has them") {
    if (!device().info().fp64) return;
    CELLIST_RANDOM(random, 83u);
    const std::vector<cl_ulong> bits{
        0x0000000000000000, 0x8000000000000000, 0x0000000000000001, 0x8000000000000001,
        0x000FFFFFFFFFFFFF, 0x0010000000000000, 0x3FF0000000000000, 0xBFF0000000000000,
        0x3FF0000000000001, 0x7FEFFFFFFFFFFFFF, 0xFFEFFFFFFFFFFFFF, 0x7FF0000000000000,
        0xFFF0000000000000, 0x7FF8000000000000, 0xFFF8000000000000, 0xFFFFFFFFFFFFFFFF};
    Inserts<Wide> inserts;
    for (cl_uint i = 0; i < 300; ++i)
        inserts.add(
            i % 2,
            {std::bit_cast<cl_double>(bits[below(random, static_cast<cl_uint>(bits.size()))]), i});
    Lists<Wide> lists(device(), {2});
    Inserter(lists).build(lists, inserts);
    lists.sort(&Wide::key);
    const HostLists<Wide> found = lists.download();
    require_same(found, oracle_of(inserts, 2));
    for (std::uint64_t cell = 0; cell < 2; ++cell)
        require_float_order<Wide, cl_ulong>(found.cell(cell));
}

TEST_CASE("a device without doubles refuses records with doubles") {
    if (device().info().fp64) return;
    REQUIRE_THROWS_AS(Lists<Wide>(device(), {2}).sort(&Wide::key), Error);
}

}  // namespace
}  // namespace cellist::test
