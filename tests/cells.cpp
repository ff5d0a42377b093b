// SPDX-License-Identifier: MIT
// Coordinates of any type become the cell that they lie in; those outside of the shape are
// rejected.
#include <cmath>
#include <limits>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

std::string cell_source(const std::string& type) {
    return "#define COORDINATE " + type + R"(
#include <cellist/lists.clh>

kernel void cells_of(CELLIST_LISTS(Item, lists), global const COORDINATE* at, uint count,
                     global uint* cells)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    const COORDINATE x = at[4 * i], y = at[4 * i + 1], z = at[4 * i + 2], w = at[4 * i + 3];
    Item item = { 0.0f, i };
    cells[4 * i] = cellist_cell1(lists, x);
    cells[4 * i + 1] = cellist_cell2(lists, x, y);
    cells[4 * i + 2] = cellist_cell3(lists, x, y, z);
    cells[4 * i + 3] = cellist_cell4(lists, x, y, z, w);
    cellist_insert(lists, cells[4 * i + 3], item);
}
)";
}

/// The index that a coordinate means along an extent, if it is inside.
template <class C>
std::optional<std::uint64_t> index_of(C coordinate, std::uint64_t extent) {
    if constexpr (std::is_floating_point_v<C>) {
        if (std::isnan(coordinate) || std::floor(coordinate) < 0 ||
            static_cast<double>(std::floor(coordinate)) >= static_cast<double>(extent))
            return {};
        return static_cast<std::uint64_t>(std::floor(coordinate));
    } else {
        if (std::cmp_less(coordinate, 0) || std::cmp_greater_equal(coordinate, extent)) return {};
        return static_cast<std::uint64_t>(coordinate);
    }
}

template <class C>
void check_cells(const std::string& type, const std::vector<C>& interesting,
                 Storage storage = Storage::linked) {
    INFO("coordinates of type " << type);
    CELLIST_RANDOM(random, 100u);
    const Shape shape{5, 4, 3, 2};
    std::vector<std::array<C, 4>> points;
    for (const C value : interesting)
        for (std::size_t dimension = 0; dimension < 4; ++dimension) {
            points.push_back({C(1), C(1), C(1), C(1)});
            points.back()[dimension] = value;
        }
    for (int i = 0; i < 2000; ++i) {
        points.emplace_back();
        for (C& coordinate : points.back())
            coordinate = below(random, 3) == 0
                             ? interesting[below(random, static_cast<cl_uint>(interesting.size()))]
                             : static_cast<C>(below(random, 6));
    }
    std::vector<C> coordinates;
    for (const auto& point : points)
        coordinates.insert(coordinates.end(), point.begin(), point.end());

    Lists<Item> lists(device(), shape, {.storage = storage});
    Kernel kernel(device(), cell_source(type), "cells_of", lists);
    const Buffer<C> at(device(), coordinates);
    const Buffer<cl_uint> device_cells(device(), coordinates.size());
    const auto count = static_cast<cl_uint>(points.size());
    const BuildReport report =
        lists.build(kernel, Range::padded(count, 64), at, count, device_cells);

    const std::vector<cl_uint> cells = device_cells.download();
    std::vector<std::size_t> per_cell(shape.cells(), 0);
    std::uint64_t rejected = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        INFO("point " << points[i][0] << ", " << points[i][1] << ", " << points[i][2] << ", "
                      << points[i][3]);
        std::uint64_t index = 0;
        std::uint64_t stride = 1;
        bool inside = true;
        for (std::size_t dimension = 0; dimension < 4; ++dimension) {
            const auto along = index_of(points[i][dimension], shape.extent(dimension));
            inside = inside && along.has_value();
            index += along.value_or(0) * stride;
            stride *= shape.extent(dimension);
            REQUIRE(cells[4 * i + dimension] == (inside ? index : 0xFFFFFFFFu));
        }
        if (inside)
            ++per_cell[index];
        else
            ++rejected;
    }
    REQUIRE(report.rejected == rejected);
    REQUIRE(report.attempted == points.size());
    REQUIRE(report.stored == points.size() - rejected);
    require_sound(lists, report.stored);
    const HostLists<Item> host = lists.download();
    for (std::uint64_t cell = 0; cell < shape.cells(); ++cell)
        REQUIRE(host.cell(cell).size() == per_cell[cell]);
}

template <class C>
std::vector<C> integers() {
    std::vector<C> values{0, 1, 2, 3, 4, 5, 6, 127};
    values.push_back(std::numeric_limits<C>::max());
    values.push_back(std::numeric_limits<C>::min());
    if constexpr (std::is_signed_v<C>) values.insert(values.end(), {C(-1), C(-2), C(-5)});
    if constexpr (sizeof(C) == 8)
        values.insert(values.end(), {C(1) << 31, C(1) << 32, (C(1) << 32) + 1, (C(1) << 32) + 5,
                                     (C(1) << 40) + 2});
    return values;
}

TEST_CASE("int coordinates") {
    CELLIST_EACH_STORAGE(storage);
    check_cells<cl_int>("int", integers<cl_int>(), storage);
}
TEST_CASE("uint coordinates") {
    std::vector<cl_uint> values = integers<cl_uint>();
    values.push_back(0x80000000u);
    values.push_back(0x80000001u);
    check_cells<cl_uint>("uint", values);
}
TEST_CASE("long coordinates") {
    std::vector<cl_long> values = integers<cl_long>();
    values.push_back(-(cl_long{1} << 32));
    values.push_back(1 - (cl_long{1} << 32));
    check_cells<cl_long>("long", values);
}
TEST_CASE("ulong coordinates") { check_cells<cl_ulong>("ulong", integers<cl_ulong>()); }
TEST_CASE("short and char coordinates") {
    check_cells<cl_short>("short", integers<cl_short>());
    check_cells<cl_ushort>("ushort", integers<cl_ushort>());
    check_cells<cl_char>("char", integers<cl_char>());
    check_cells<cl_uchar>("uchar", integers<cl_uchar>());
}

template <class F>
std::vector<F> floats() {
    using Limits = std::numeric_limits<F>;
    std::vector<F> values{F(0),
                          -F(0),
                          F(0.5),
                          F(-0.5),
                          F(1),
                          F(-1),
                          F(2147483648.0),
                          F(-2147483648.0),
                          F(4294967296.0),
                          F(4294967297.0),
                          F(1e30),
                          F(-1e30),
                          Limits::max(),
                          Limits::lowest(),
                          Limits::denorm_min(),
                          Limits::infinity(),
                          -Limits::infinity(),
                          Limits::quiet_NaN(),
                          -Limits::quiet_NaN(),
                          F(-1e-20),
                          F(1e-20)};
    for (const F extent : {F(2), F(3), F(4), F(5)}) {
        values.push_back(extent);
        values.push_back(std::nextafter(extent, F(0)));
        values.push_back(std::nextafter(extent, F(10)));
    }
    return values;
}

TEST_CASE("float coordinates are rounded down, and NaN is outside") {
    check_cells<cl_float>("float", floats<cl_float>());
}
TEST_CASE("double coordinates are rounded down, where the device has them") {
    if (device().info().fp64) check_cells<cl_double>("double", floats<cl_double>());
}

TEST_CASE("the largest extents are addressed to their last cell") {
    // No container of this size is made: its view is all that the helpers read.
    const Lists<Item> lists(device(), {1});
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void largest(CELLIST_LISTS(Item, small), global uint* cells)
{
    cellist_view_Item large_typed = small_typed;
    large_typed.cellist_untyped.extent[0] = 0x7FFFFFFFu;
    large_typed.cellist_untyped.extent[1] = 2u;
    large_typed.cellist_untyped.cells = 0xFFFFFFFEu;
    cells[0] = cellist_cell2(large, 0x7FFFFFFEu, 1);
    cells[1] = cellist_cell2(large, 0x7FFFFFFFu, 1);
    cells[2] = cellist_cell2(large, 2147483647.0f, 0);
    cells[3] = cellist_cell2(large, 2147483520.0f, 1);
    cells[4] = cellist_cell2(large, (ulong)0x7FFFFFFE, 0L);
    cells[5] = cellist_cell2(large, 3, 2);
}
)",
                  "largest", lists);
    const Buffer<cl_uint> cells(device(), 6);
    kernel.run(1, lists, cells);
    REQUIRE(cells.download() == std::vector<cl_uint>{0xFFFFFFFDu, 0xFFFFFFFFu, 0xFFFFFFFFu,
                                                     0xFFFFFF7Fu, 0x7FFFFFFEu, 0xFFFFFFFFu});
}

TEST_CASE("cell indices of any integer type are checked") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(device(), {10}, {.storage = storage});
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void indices(CELLIST_LISTS(Item, lists), global uint* lengths)
{
    Item item = { 0.0f, 0 };
    cellist_insert(lists, -1, item);
    cellist_insert(lists, (int)0x80000000, item);
    cellist_insert(lists, -4294967293L, item);
    cellist_insert(lists, 4294967299UL, item);
    cellist_insert(lists, 4294967299L, item);
    cellist_insert(lists, 0xFFFFFFFFFFFFFFFFUL, item);
    cellist_insert(lists, 0xFFFFFFFFu, item);
    cellist_insert(lists, CELLIST_NONE, item);
    cellist_insert(lists, 10, item);
    cellist_insert(lists, (short)-3, item);
    cellist_insert(lists, (uchar)200, item);

    cellist_insert(lists, 9, item);
    cellist_insert(lists, 9u, item);
    cellist_insert(lists, 9L, item);
    cellist_insert(lists, 9UL, item);
    cellist_insert(lists, (short)9, item);
    cellist_insert(lists, (uchar)9, item);
    cellist_insert(lists, get_global_id(0) + 9, item);
}
)",
                  "indices", lists);
    const Buffer<cl_uint> lengths(device(), 1);
    const BuildReport report = lists.build(kernel, 1, lengths);
    REQUIRE(report.rejected == 11);
    REQUIRE(report.stored == 7);
    require_sound(lists, 7);
    const HostLists<Item> host = lists.download();
    REQUIRE(host[{9}].size() == 7);
}

TEST_CASE("walks nest, and their bodies may break and continue") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(device(), {10}, {.storage = storage});
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 144; ++i) inserts.add(i % 10, {0.0F, i});
    Inserter(lists).build(lists, inserts);
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void walk(CELLIST_LISTS(Item, lists), global uint* found)
{
    uint pairs = 0, firsts = 0, even = 0, own = 0;
    for (int cell = 0; cell < 10; ++cell) {
        cellist_for_each(lists, cell, a) cellist_for_each(lists, cell, b) ++pairs;
        cellist_for_each(lists, cell, node) { ++firsts; break; }
        cellist_for_each(lists, cell, node) {
            if (cellist_get(lists, node).id % 2) continue;
            ++even;
        }
    }
    const uint node_cell = 3;
    cellist_for_each(lists, node_cell, node) ++own;
    found[0] = pairs;
    found[1] = firsts;
    found[2] = even;
    found[3] = own;
}
)",
                  "walk", lists);
    const Buffer<cl_uint> found(device(), 4);
    kernel.run(1, lists, found);
    // 4 cells with 15 items, and 6 with 14.
    REQUIRE(found.download() == std::vector<cl_uint>{4 * 225 + 6 * 196, 10, 72, 15});
}

TEST_CASE("walking a cell outside of the shape visits nothing") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 101u);
    Lists<Item> lists(device(), {10}, {.storage = storage});
    Inserter(lists).build(lists, random_inserts(144, 10, random));
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void walk(CELLIST_LISTS(Item, lists), global uint* visited)
{
    uint outside = 0, inside = 0;
    cellist_for_each(lists, -1, node) ++outside;
    cellist_for_each(lists, 10, node) ++outside;
    cellist_for_each(lists, CELLIST_NONE, node) ++outside;
    cellist_for_each(lists, 4294967299UL, node) ++outside;
    cellist_for_each(lists, cellist_cell1(lists, NAN), node) ++outside;
    for (int cell = 0; cell < 10; ++cell)
        cellist_for_each(lists, cell, node) ++inside;
    visited[0] = outside;
    visited[1] = inside;
}
)",
                  "walk", lists);
    const Buffer<cl_uint> visited(device(), 2);
    kernel.run(1, lists, visited);
    REQUIRE(visited.download() == std::vector<cl_uint>{0, 144});
}

}  // namespace
}  // namespace cellist::test
