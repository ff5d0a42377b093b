// SPDX-License-Identifier: MIT
// Adapted structs have the same members at the same places on the host and on the device.
#include <cstdint>

#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

enum class Kind : cl_ushort { point = 3, face = 65535 };
enum Colour { red, green = 1 << 20 };

struct Inner {
    cl_uchar tag;
    cl_short2 at;
};
CELLIST_STRUCT(Inner, tag, at);

/// Members of every kind, with padding between them.
struct Everything {
    char sign;
    std::uint64_t wide;
    std::int8_t small;
    Kind kind;
    Colour colour;
    long native_long;
    unsigned long long native_ulong;
    cl_float2 pair;
    cl_uchar4 rgba;
    cl_int4 quad;
    cl_short8 octet;
    cl_uchar bytes[5];
    cl_short grid[3][2];
    Inner inner;
    Inner inners[2][2];
    cl_float4 rows[2];
    cl_float scalar;
};
CELLIST_STRUCT(Everything, sign, wide, small, kind, colour, native_long, native_ulong, pair, rgba,
               quad, octet, bytes, grid, inner, inners, rows, scalar);

/// The value of the n-th scalar: different for each, and small enough for a char.
constexpr int value_of(int n) { return n + 2; }

Everything example() {
    Everything e{};
    int n = 0;
    const auto next = [&n] { return value_of(n++); };
    e.sign = static_cast<char>(next());
    e.wide = static_cast<std::uint64_t>(next()) << 40;
    e.small = static_cast<std::int8_t>(-next());
    e.kind = Kind::face, next();
    e.colour = green, next();
    e.native_long = -(static_cast<long>(next()) << 40);
    e.native_ulong = static_cast<unsigned long long>(next()) << 50;
    for (cl_float& s : e.pair.s) s = static_cast<cl_float>(next());
    for (cl_uchar& s : e.rgba.s) s = static_cast<cl_uchar>(next());
    for (cl_int& s : e.quad.s) s = -next();
    for (cl_short& s : e.octet.s) s = static_cast<cl_short>(-next());
    for (cl_uchar& s : e.bytes) s = static_cast<cl_uchar>(next());
    for (auto& row : e.grid)
        for (cl_short& s : row) s = static_cast<cl_short>(next());
    const auto set = [&](Inner& inner) {
        inner.tag = static_cast<cl_uchar>(next());
        for (cl_short& s : inner.at.s) s = static_cast<cl_short>(next());
    };
    set(e.inner);
    for (auto& row : e.inners)
        for (Inner& inner : row) set(inner);
    for (cl_float4& row : e.rows)
        for (cl_float& s : row.s) s = static_cast<cl_float>(next());
    e.scalar = static_cast<cl_float>(next()) / 4;
    return e;
}

void require_equal(const Everything& a, const Everything& b) {
    REQUIRE(a.sign == b.sign);
    REQUIRE(a.wide == b.wide);
    REQUIRE(a.small == b.small);
    REQUIRE(a.kind == b.kind);
    REQUIRE(a.colour == b.colour);
    REQUIRE(a.native_long == b.native_long);
    REQUIRE(a.native_ulong == b.native_ulong);
    const auto same = [](const auto& x, const auto& y) {
        return std::equal(std::begin(x), std::end(x), std::begin(y));
    };
    REQUIRE(same(a.pair.s, b.pair.s));
    REQUIRE(same(a.rgba.s, b.rgba.s));
    REQUIRE(same(a.quad.s, b.quad.s));
    REQUIRE(same(a.octet.s, b.octet.s));
    REQUIRE(same(a.bytes, b.bytes));
    for (int row = 0; row < 3; ++row) REQUIRE(same(a.grid[row], b.grid[row]));
    const auto same_inner = [&](const Inner& x, const Inner& y) {
        return x.tag == y.tag && same(x.at.s, y.at.s);
    };
    REQUIRE(same_inner(a.inner, b.inner));
    for (int row = 0; row < 2; ++row) {
        for (int column = 0; column < 2; ++column)
            REQUIRE(same_inner(a.inners[row][column], b.inners[row][column]));
        REQUIRE(same(a.rows[row].s, b.rows[row].s));
    }
    REQUIRE(a.scalar == b.scalar);
}

constexpr auto everything_source = R"(
#include <cellist/lists.clh>

// The same values as example() in the host program, by the members' names.
static Everything example(void)
{
    Everything e;
    int n = 2;
    e.sign = n++;
    e.wide = (ulong)n++ << 40;
    e.small = -n++;
    e.kind = 65535, n++;
    e.colour = 1 << 20, n++;
    e.native_long = -((long)n++ << 40);
    e.native_ulong = (ulong)n++ << 50;
    e.pair = (float2)(n, n + 1), n += 2;
    e.rgba = (uchar4)(n, n + 1, n + 2, n + 3), n += 4;
    e.quad = -(int4)(n, n + 1, n + 2, n + 3), n += 4;
    e.octet = -(short8)(n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, n + 7), n += 8;
    for (int i = 0; i < 5; ++i) e.bytes[i] = n++;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) e.grid[i][j] = n++;
    e.inner.tag = n++;
    e.inner.at = (short2)(n, n + 1), n += 2;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            e.inners[i][j].tag = n++;
            e.inners[i][j].at = (short2)(n, n + 1), n += 2;
        }
    for (int i = 0; i < 2; ++i) e.rows[i] = (float4)(n, n + 1, n + 2, n + 3), n += 4;
    e.scalar = n / 4.0f;
    return e;
}

kernel void write_all(global Everything* out)
{
    out[get_global_id(0)] = example();
}
kernel void insert_all(CELLIST_LISTS(Everything, lists))
{
    cellist_insert(lists, get_global_id(0), example());
}

// 0 if the value is not the example's by the comparison of all members, which orders the records.
kernel void compare(Everything by_value, global const Everything* in, global uint* same)
{
    const Everything e = example(), other = in[0];
    same[0] = !cellist_record_before(by_value, e, 0) && !cellist_record_before(e, by_value, 0);
    same[1] = !cellist_record_before(other, e, 0) && !cellist_record_before(e, other, 0);
    same[2] = by_value.inners[1][0].at.y == e.inners[1][0].at.y && other.grid[2][1] == e.grid[2][1]
           && by_value.rows[1].w == e.rows[1].w && other.octet.s7 == e.octet.s7;
    same[3] = sizeof(Everything);
}
)";

TEST_CASE("values that the device writes are read by the host, member by member") {
    const Buffer<Everything> out(device(), 3);
    Kernel write(device(), everything_source, "write_all", type<Everything>);
    write.run(3, out);
    for (const Everything& everything : out.download()) require_equal(everything, example());
}

TEST_CASE("values that the host writes are read by the device, by value and in buffers") {
    const Buffer<Everything> in(device(), std::vector<Everything>{example()});
    const Buffer<cl_uint> same(device(), 4);
    Kernel compare(device(), everything_source, "compare", type<Everything>);
    compare.run(1, example(), in, same);
    REQUIRE(same.download() == std::vector<cl_uint>{1, 1, 1, sizeof(Everything)});

    Everything other = example();
    other.inners[1][1].at.s[1] = 1;
    const Buffer<Everything> in_other(device(), std::vector<Everything>{other});
    compare.run(1, other, in_other, same);
    REQUIRE(same.download() == std::vector<cl_uint>{0, 0, 1, sizeof(Everything)});
}

TEST_CASE("records of many members and padding are inserted, sorted and downloaded") {
    Lists<Everything> lists(device(), {5});
    Kernel insert(device(), everything_source, "insert_all", lists);
    require_complete(lists.build(insert, 6), 5, 1);
    lists.sort(&Everything::kind);
    lists.sort(&Everything::native_long);
    lists.sort_by("record.inners[1][0].at.y");
    require_sound(lists, 5);
    const HostLists<Everything> host = lists.download();
    for (std::uint64_t cell = 0; cell < 5; ++cell) {
        REQUIRE(host.cell(cell).size() == 1);
        require_equal(host.cell(cell)[0], example());
    }
}

struct node {
    cl_float size;
    cl_uint next;
};
CELLIST_STRUCT(node, size, next);
struct record {
    cl_float size;
    cl_uint next;
};
CELLIST_STRUCT(record, size, next);
struct key {
    cl_float size;
    cl_uint next;
};
CELLIST_STRUCT(key, size, next);

/// Inserts 9, 8, ... 0 into one cell, and takes the three nearest.
template <class T>
void require_nearest() {
    const std::string name = DeviceType<T>::name();
    INFO(name);
    Inserts<T> inserts;
    for (cl_uint i = 0; i < 10; ++i) inserts.add(0, {static_cast<cl_float>(9 - i), i});
    for (const Storage storage : {Storage::linked, Storage::counted}) {
        Lists<T> lists(device(), {1}, {.storage = storage});
        Inserter(lists).build(lists, inserts);
        lists.sort(&T::size);
        REQUIRE(lists.download().cell(0)[3].next == 6);
        const Buffer<T> out(device(), 3);
        Kernel(device(),
               "kernel void nearest(CELLIST_LISTS(" + name + ", lists), global " + name +
                   "* to)\n{\n    " + name +
                   " best[3];\n    cellist_nearest(lists, 0, size, 3, best);\n"
                   "    for (int i = 0; i < 3; ++i) to[i] = best[i];\n}\n",
               "nearest", lists)
            .run(1, lists, out);
        REQUIRE(out.download()[2].next == 7);
    }
}

TEST_CASE("a struct may be called like a variable of the library's kernels") {
    require_nearest<node>();
    require_nearest<record>();
    require_nearest<key>();
}

}  // namespace
}  // namespace cellist::test
