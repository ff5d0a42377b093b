// SPDX-License-Identifier: MIT
// Traversals of neighbouring cells visit the records of each cell once, whatever lies beyond the
// shape.
#include <cmath>
#include <limits>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

using Position = std::array<cl_int, 4>;
using Axes = std::array<bool, 4>;

constexpr cl_int nowhere = std::numeric_limits<cl_int>::min();

constexpr auto source = R"(
#include <cellist/lists.clh>

// Counts the visits of each record from each place: visits[i * records + id].
kernel void visit_positions(CELLIST_LISTS(Item, lists), global const int4* positions, uint count,
                            uint radius, uint records, global uint* visits)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_for_each_around(lists, positions[i], radius, node)
        ++visits[i * records + cellist_get(lists, node).id];
}

kernel void visit_cells(CELLIST_LISTS(Item, lists), global const int4* positions, uint count,
                        uint radius, uint records, global uint* visits)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    const int4 at = positions[i];
    cellist_for_each_around(lists, cellist_cell4(lists, at.x, at.y, at.z, at.w), radius, node) {
        ++visits[i * records + cellist_get(lists, node).id];
    }
}
)";

/// The coordinate of a cell that a coordinate means; negative if there is none.
std::int64_t coordinate_in(std::int64_t x, std::int64_t extent, bool periodic) {
    if (extent == 0 || x == nowhere) return -1;
    if (periodic) return ((x % extent) + extent) % extent;
    return x < extent ? x : -1;
}

/// Whether a cell's coordinate is at most `radius` from a position's.
bool is_near(std::int64_t cell, std::int64_t position, std::int64_t radius, std::int64_t extent,
             bool periodic) {
    if (position == nowhere) return false;
    if (!periodic) return std::abs(cell - position) <= radius;
    const std::int64_t apart = std::abs(cell - coordinate_in(position, extent, true));
    return std::min(apart, extent - apart) <= radius;
}

struct Scene {
    Shape shape;
    Axes periodic;
    Inserts<Item> inserts;

    [[nodiscard]] std::array<std::int64_t, 4> coordinates(std::uint64_t cell) const {
        std::array<std::int64_t, 4> at{};
        for (std::size_t axis = 0; axis < 4; ++axis) {
            at[axis] = static_cast<std::int64_t>(cell % shape.extent(axis));
            cell /= shape.extent(axis);
        }
        return at;
    }
    [[nodiscard]] bool is_inside(const Position& position) const {
        for (std::size_t axis = 0; axis < 4; ++axis)
            if (coordinate_in(position[axis], static_cast<std::int64_t>(shape.extent(axis)),
                              periodic[axis]) < 0)
                return false;
        return true;
    }
    [[nodiscard]] std::vector<cl_uint> visits(const std::vector<Position>& positions,
                                              std::uint32_t radius, bool only_from_inside) const {
        std::vector<cl_uint> expected(positions.size() * inserts.size());
        for (std::size_t i = 0; i < positions.size(); ++i)
            for (std::size_t n = 0; n < inserts.size(); ++n) {
                bool near = inserts.cells[n] < shape.cells() &&
                            (!only_from_inside || is_inside(positions[i]));
                if (!near) continue;
                const auto at = coordinates(inserts.cells[n]);
                for (std::size_t axis = 0; axis < 4; ++axis)
                    near = near &&
                           is_near(at[axis], positions[i][axis], radius,
                                   static_cast<std::int64_t>(shape.extent(axis)), periodic[axis]);
                expected[i * inserts.size() + inserts.records[n].id] = near ? 1 : 0;
            }
        return expected;
    }
};

std::vector<Position> some_positions(const Shape& shape, std::mt19937& random) {
    std::vector<Position> positions{
        {0, 0, 0, 0},       {-1, -1, -1, -1},       {nowhere, 0, 0, 0},
        {0, 0, 0, nowhere}, {nowhere + 1, 0, 0, 0}, {std::numeric_limits<cl_int>::max(), 0, 0, 0}};
    for (int i = 0; i < 30; ++i) {
        positions.emplace_back();
        for (std::size_t axis = 0; axis < 4; ++axis)
            positions.back()[axis] = shape.extent(axis) == 1 && below(random, 8) != 0
                                         ? 0
                                         : static_cast<cl_int>(below(random, 30)) - 10;
    }
    return positions;
}

void check_visits(const Scene& scene, const StorageOption& storage, std::mt19937& random) {
    Lists<Item> lists(device(), scene.shape, {.storage = storage, .periodic = scene.periodic});
    Inserter<Item> inserter(lists);
    inserter.build(lists, scene.inserts);
    const auto records = static_cast<cl_uint>(scene.inserts.size());
    const std::vector<Position> positions = some_positions(scene.shape, random);
    const auto count = static_cast<cl_uint>(positions.size());
    std::vector<cl_int4> words;
    for (const Position& at : positions) words.push_back({{at[0], at[1], at[2], at[3]}});
    const Buffer<cl_int4> on_device(device(), words);
    Buffer<cl_uint> visits(device(), std::size_t{count} * records);
    for (const bool by_cell : {false, true}) {
        Kernel visit(device(), source, by_cell ? "visit_cells" : "visit_positions", lists);
        for (const cl_uint radius : {0U, 1U, 2U, 3U, 7U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
            INFO("shape " << scene.shape.to_string() << ", radius " << radius << ", by cell "
                          << by_cell);
            visits.fill(0);
            visit.run(Range::padded(count, 64), lists, on_device, count, radius, records, visits);
            REQUIRE(visits.download() == scene.visits(positions, radius, by_cell));
        }
    }
}

TEST_CASE("all shapes and periodic axes") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 300u);
    const std::vector<std::pair<Shape, Axes>> cases{{{1}, {}},
                                                    {{1}, {true}},
                                                    {{7}, {true}},
                                                    {{9}, {}},
                                                    {{5, 4}, {true, false}},
                                                    {{4, 5}, {false, true}},
                                                    {{2, 3}, {true, true}},
                                                    {{6, 5, 4}, {}},
                                                    {{6, 5, 4}, {true, true, true}},
                                                    {{3, 8, 1}, {true, false, true}},
                                                    {{3, 4, 2, 5}, {false, true, false, true}}};
    for (const auto& [shape, periodic] : cases)
        check_visits({shape, periodic,
                      random_inserts(200, static_cast<std::uint32_t>(shape.cells()) + 1, random)},
                     storage, random);
}

TEST_CASE("the lists of nearest()") {
    CELLIST_RANDOM(random, 301u);
    const Shape shape{5, 4, 3};
    check_visits({shape, {true, false, true}, random_inserts(200, 60, random)},
                 nearest(&Item::key, 64), random);
}

TEST_CASE("no cells and no records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 302u);
    check_visits({{3, 3}, {true}, {}}, storage, random);
    check_visits({{3, 0, 2}, {true, true, true}, random_inserts(3, 1, random)}, storage, random);
}

TEST_CASE("break, continue, nesting, and containers of different storages", "[oclgrind]") {
    CELLIST_RANDOM(random, 303u);
    const Shape shape{4, 4, 2};
    const Axes periodic{true, true, false};
    const Inserts<Item> inserts = random_inserts(60, 32, random);
    std::vector<Lists<Item>> lists;
    for (const Storage storage : {Storage::linked, Storage::counted}) {
        lists.emplace_back(device(), shape, ListsOptions{.storage = storage, .periodic = periodic});
        Inserter<Item>(lists.back()).build(lists.back(), inserts);
    }
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void sums(CELLIST_LISTS(Item, a), CELLIST_LISTS(Item, b), global uint4* found)
{
    const uint cell = get_global_id(0);
    uint4 sums = 0;
    cellist_for_each_around(a, cell, 1, first) {
        ++sums.x;
        if (cellist_get(a, first).id % 3 == 0) continue;
        ++sums.y;
        cellist_for_each_around(b, cell, 1, second) {
            if (cellist_get(b, second).id == cellist_get(a, first).id) {
                ++sums.z;
                break;
            }
        }
    }
    cellist_for_each_around(b, (ulong)cell, 2, third) {
        if (++sums.w == 5) break;
    }
    found[cell] = sums;
}
)",
                  "sums", lists[0], lists[1]);
    Buffer<cl_uint4> found(device(), shape.cells());
    kernel.run(shape.cells(), lists[0], lists[1], found);
    const std::vector<cl_uint4> sums = found.download();

    const Scene scene{shape, periodic, inserts};
    for (std::uint64_t cell = 0; cell < shape.cells(); ++cell) {
        const auto at = scene.coordinates(cell);
        const Position position{static_cast<cl_int>(at[0]), static_cast<cl_int>(at[1]),
                                static_cast<cl_int>(at[2]), 0};
        const std::vector<cl_uint> visits = scene.visits({position}, 1, false);
        cl_uint all = 0;
        cl_uint kept = 0;
        for (std::size_t id = 0; id < visits.size(); ++id) {
            all += visits[id];
            kept += id % 3 == 0 ? 0 : visits[id];
        }
        INFO("cell " << cell);
        REQUIRE(sums[cell].s[0] == all);
        REQUIRE(sums[cell].s[1] == kept);
        REQUIRE(sums[cell].s[2] == kept);
        REQUIRE(sums[cell].s[3] == 5);
    }
}

TEST_CASE("inserts wrap around periodic axes") {
    CELLIST_EACH_STORAGE(storage);
    constexpr auto insert = R"(
#include <cellist/lists.clh>
kernel void insert_points(CELLIST_LISTS(Item, lists), global const float4* points, uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    Item item = { points[i].x, i };
    cellist_insert(lists, cellist_cell3(lists, points[i].x, points[i].y, (ulong)points[i].z), item);
}
)";
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr cl_uint rejected = 0xFFFFFFFF;
    // Points, and the cells that they lie in.
    const std::vector<std::pair<std::array<float, 3>, cl_uint>> points{
        {{0, 0, 0}, 0},
        {{4.5F, 3.5F, 0}, 19},
        {{5, 0, 0}, 0},
        {{-0.5F, 0, 0}, 4},
        {{-5, 0, 0}, 0},
        {{-6.5F, 0, 0}, 3},
        {{1e6F + 2, 0, 0}, 2},
        {{-1e6F - 2, 0, 0}, 3},
        {{0, 4, 0}, rejected},
        {{0, -1, 0}, rejected},
        {{0, 0, 7}, 20},
        {{0, 0, 3e9F}, rejected},
        {{2147483520.0F, 0, 0}, 0},
        {{-2147483520.0F, 0, 0}, 0},
        {{2147483648.0F, 0, 0}, rejected},
        {{-2147483648.0F, 0, 0}, rejected},
        {{nan, 0, 0}, rejected},
        {{infinity, 0, 0}, rejected},
        {{-infinity, 0, 0}, rejected},
    };
    Lists<Item> lists(device(), {5, 4, 2}, {.storage = storage, .periodic = {true, false, true}});
    Kernel kernel(device(), insert, "insert_points", lists);
    std::vector<cl_float4> words;
    Oracle<Item> oracle;
    for (const auto& [point, cell] : points) {
        if (cell != rejected) oracle.emplace(cell, Item{point[0], cl_uint(words.size())});
        words.push_back({{point[0], point[1], point[2], 0}});
    }
    const Buffer<cl_float4> on_device(device(), words);
    const BuildReport report =
        lists.build(kernel, words.size(), on_device, static_cast<cl_uint>(words.size()));
    require_complete(report, oracle.size(), points.size() - oracle.size());
    require_same(lists.download(), oracle);
}

TEST_CASE("slices of a periodic shape") {
    CELLIST_EACH_STORAGE(storage);
    Kernel kernel(device(), R"(
#include <cellist/lists.clh>
kernel void insert_all(CELLIST_LISTS(Item, lists), uint count)
{
    const int i = get_global_id(0);
    Item item = { i, i };
    cellist_insert(lists, cellist_cell2(lists, i - 50, i), item);
}
)",
                  "insert_all", cellist::type<Item>);
    constexpr cl_uint count = 100;
    // No more than one of five rows fits into a pool.
    Lists<Item> lists(device(), {4, 5},
                      {.storage = storage,
                       .overflow = Overflow::drop,
                       .capacity_nodes = 20,
                       .slots = 5,
                       .periodic = {true, true}});
    std::vector<cl_uint> lengths(20);
    for (cl_uint i = 0; i < count; ++i) ++lengths[(i + 2) % 4 + i % 5 * 4];
    std::uint64_t cells = 0;
    const BuildReport report =
        lists.build_slices([&] { kernel.run(count, lists, count); },
                           [&](const Slice& slice) {
                               const Lengths found = lists.lengths();
                               std::uint64_t total = 0;
                               for (std::uint64_t cell = slice.first_cell;
                                    cell < slice.first_cell + slice.cells; ++cell, ++cells)
                                   total += lengths[cell];
                               CHECK(found.total == total);
                           });
    CHECK(cells == 20);
    CHECK(report.rejected == 0);
    CHECK(report.stored == count);
}

TEST_CASE("positions of points have the coordinates of their cells") {
    Kernel kernel(device(), R"(
kernel void positions(global const float4* points, global int4* found)
{
    const float4 p = points[get_global_id(0)];
    found[4 * get_global_id(0)] = cellist_position1(p.x);
    found[4 * get_global_id(0) + 1] = cellist_position2(p.x, (long)p.y);
    found[4 * get_global_id(0) + 2] = cellist_position3(p.x, p.y, p.z);
    found[4 * get_global_id(0) + 3] = cellist_position4(p.x, p.y, p.z, p.w);
}
)",
                  "positions");
    const std::vector<cl_float4> points{
        {{-0.5F, 2, 3.75F, -7}},
        {{std::numeric_limits<float>::quiet_NaN(), 3e9F, -3e9F, 2147483520.0F}}};
    Buffer<cl_int4> found(device(), 8);
    kernel.run(2, Buffer<cl_float4>(device(), points), found);
    const std::vector<cl_int4> positions = found.download();
    const std::vector<Position> expected{{-1, 0, 0, 0},
                                         {-1, 2, 0, 0},
                                         {-1, 2, 3, 0},
                                         {-1, 2, 3, -7},
                                         {nowhere, 0, 0, 0},
                                         {nowhere, nowhere, 0, 0},
                                         {nowhere, nowhere, nowhere, 0},
                                         {nowhere, nowhere, nowhere, 2147483520}};
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (std::size_t axis = 0; axis < 4; ++axis)
            CHECK(positions[i].s[axis] == expected[i][axis]);
}

TEST_CASE("the length of a vector") {
    Kernel kernel(device(), R"(
kernel void lengths(const float4 v, global float* found)
{
    found[0] = cellist_norm(v.xy);
    found[1] = cellist_norm(v.xyz);
    found[2] = cellist_norm(v);
}
)",
                  "lengths");
    Buffer<cl_float> found(device(), 3);
    kernel.run(1, cl_float4{{3, -4, 12, 84}}, found);
    CHECK(found.download()[0] == Approx(5));
    CHECK(found.download()[1] == Approx(13));
    CHECK(found.download()[2] == Approx(85));
}

TEST_CASE("the minimum image of a difference") {
    Kernel kernel(device(), R"(
kernel void images(global const float4* differences, const float4 box, global float4* found)
{
    const float4 d = differences[get_global_id(0)];
    found[2 * get_global_id(0)] = cellist_minimum_image(d, box);
    const float3 image = cellist_minimum_image(d.xyz, box.xyz);
    found[2 * get_global_id(0) + 1] = (float4)(image, cellist_minimum_image(d.w, box.w));
}
)",
                  "images");
    CELLIST_RANDOM(random, 304u);
    std::uniform_real_distribution<float> coordinate(-20, 20);
    std::vector<cl_float4> differences{{{0, 0, 0, 0}}, {{0.5F, -0.5F, 1, -1}}};
    for (int i = 0; i < 200; ++i)
        differences.push_back(
            {{coordinate(random), coordinate(random), coordinate(random), coordinate(random)}});
    const cl_float4 box{{1, 2.5F, 0, 1e30F}};
    Buffer<cl_float4> found(device(), 2 * differences.size());
    kernel.run(differences.size(), Buffer<cl_float4>(device(), differences), box, found);
    const std::vector<cl_float4> images = found.download();
    for (std::size_t i = 0; i < images.size(); ++i)
        for (std::size_t axis = 0; axis < 4; ++axis) {
            const double difference = static_cast<double>(differences[i / 2].s[axis]);
            const double side = static_cast<double>(box.s[axis]);
            const double image = static_cast<double>(images[i].s[axis]);
            const double least =
                side > 0 ? std::abs(std::remainder(difference, side)) : std::abs(difference);
            INFO("difference " << difference << ", box " << side << ", image " << image);
            CHECK(std::abs(std::abs(image) - least) <= 1e-5);
            if (side > 0) CHECK(std::abs(std::remainder(difference - image, side)) <= 1e-5);
        }
}

}  // namespace
}  // namespace cellist::test
