// SPDX-License-Identifier: MIT
// The expression of sort_by uses values by their names. Kernels take values as arguments.
#include <cmath>

#include "sort/key.hpp"
#include "support/errors.hpp"
#include "support/internals.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

struct Point {
    cl_float4 at;
    cl_int id;
};
CELLIST_STRUCT(Point, at, id);

/// A value may be an adapted struct that the record does not contain.
struct Camera {
    cl_int offset;
    cl_short steps[3];
};
CELLIST_STRUCT(Camera, offset, steps);

/// Lists of several classes, with points on a grid whose distances are exact.
Inserts<Point> point_inserts(std::mt19937& random) {
    Inserts<Point> inserts;
    for (const cl_uint length : {0u, 1u, 20u, 100u, 700u})
        for (cl_uint i = 0; i < length; ++i) {
            const auto coordinate = [&] { return static_cast<cl_float>(below(random, 32)); };
            inserts.add(length / 10 % 8, {{{coordinate(), coordinate(), coordinate(), 0}},
                                          static_cast<cl_int>(inserts.size())});
        }
    return inserts;
}
constexpr std::uint64_t point_cells = 8;

/// The square of the distance, then the members. No two points have the same id.
auto nearer_to(const cl_float4& query, Order order = Order::ascending) {
    return [query, order](const Point& a, const Point& b) {
        const auto square = [&](const Point& point) {
            cl_float sum = 0;
            for (int i = 0; i < 4; ++i)
                sum += (point.at.s[i] - query.s[i]) * (point.at.s[i] - query.s[i]);
            return sum;
        };
        const auto members = [](const Point& point) {
            return std::tuple(point.at.s[0], point.at.s[1], point.at.s[2], point.id);
        };
        if (square(a) != square(b))
            return order == Order::ascending ? square(a) < square(b) : square(a) > square(b);
        return members(a) < members(b);
    };
}

constexpr auto square_of_distance = "dot(record.at - query, record.at - query)";

void require_order(const Lists<Point>& lists, const Inserts<Point>& inserts, auto before,
                   std::size_t count = 1000) {
    const HostLists<Point> found = lists.download();
    const HostLists<Point> expected = sorted_lists(inserts, point_cells, before);
    REQUIRE(found.offsets() == expected.offsets());
    for (std::uint64_t cell = 0; cell < point_cells; ++cell)
        for (std::size_t i = 0; i < std::min(count, found.cell(cell).size()); ++i)
            REQUIRE(found.cell(cell)[i].id == expected.cell(cell)[i].id);
}

TEST_CASE("lists are sorted by an expression of values in every way") {
    CELLIST_EACH_STORAGE(storage);
    const cl_device_type division =
        GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU});
    CELLIST_RANDOM(random, 190u);
    const Inserts<Point> inserts = point_inserts(random);
    Lists<Point> lists(device(), {point_cells}, {.storage = storage});
    sort_as_on(lists, division);
    Inserter inserter(lists);
    inserter.build(lists, inserts);

    const cl_float4 first{{3, 4, 5, 0}}, second{{20, 30, 0, 1}};
    lists.sort_by(square_of_distance, {{"query", first}});
    require_order(lists, inserts, nearer_to(first));
    lists.sort_by(square_of_distance, {{"query", second}}, Order::descending);
    require_order(lists, inserts, nearer_to(second, Order::descending));
    lists.sort_by_async(square_of_distance, {{"query", first}}, Order::descending);
    require_order(lists, inserts, nearer_to(first, Order::descending));
    inserter.build(lists, inserts);
    lists.partial_sort_by(square_of_distance, {{"query", second}}, 3);
    require_order(lists, inserts, nearer_to(second), 3);
    require_sound(lists, inserts.size());
}

TEST_CASE("the first of long lists are found by an expression of values") {
    CELLIST_RANDOM(random, 191u);
    Inserts<Point> inserts;
    for (cl_int i = 0; i < 6000; ++i)
        inserts.add(below(random, 3), {{{static_cast<cl_float>(below(random, 64)), 0, 0, 0}}, i});
    Lists<Point> lists(device(), {point_cells});
    Inserter(lists).build(lists, inserts);
    const cl_float4 query{{40, 0, 0, 0}};
    lists.partial_sort_by(square_of_distance, {{"query", query}}, 5);
    require_order(lists, inserts, nearer_to(query), 5);
}

TEST_CASE("values have every type that members have") {
    Lists<Point> lists(device(), {1});
    Inserts<Point> inserts;
    for (cl_int i = 0; i < 300; ++i) inserts.add(0, {{}, i * 7 % 300});
    Inserter(lists).build(lists, inserts);
    enum class Level : cl_ushort { high = 500 };
    const auto first = [&](const std::string& expression, const Values& values) {
        INFO(expression);
        lists.sort_by(expression, values);
        return lists.download().records().front().id;
    };
    REQUIRE(first("abs(record.id - x)", {{"x", cl_char{-3}}}) == 0);
    REQUIRE(first("abs(record.id - x)", {{"x", cl_uchar{200}}}) == 200);
    REQUIRE(first("abs(record.id - x)", {{"x", cl_short{201}}}) == 201);
    REQUIRE(first("abs(record.id - (int)x)", {{"x", cl_long{202}}}) == 202);
    REQUIRE(first("abs(record.id - (int)x)", {{"x", cl_ulong{203}}}) == 203);
    REQUIRE(first("abs(record.id - x)", {{"x", Level::high}}) == 299);
    REQUIRE(first("fabs(record.id - x.y)", {{"x", cl_float2{{1, 204}}}}) == 204);
    REQUIRE(first("abs(record.id - x.sf)",
                  {{"x", cl_int16{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 205}}}}) == 205);
    REQUIRE(first("abs(record.id - x.offset - x.steps[2])", {{"x", Camera{100, {0, 0, 106}}}}) ==
            206);
    REQUIRE(first("abs(record.id - x.id)", {{"x", Point{{}, 207}}}) == 207);
    // Each at its own alignment, and one that is not used.
    REQUIRE(first("abs(record.id - a - (int)b.w - c - (int)d)", {{"a", cl_char{1}},
                                                                 {"b", cl_float4{{0, 0, 0, 2}}},
                                                                 {"unused", cl_short{5000}},
                                                                 {"c", cl_uchar{3}},
                                                                 {"d", cl_long{202}}}) == 208);
    if (device().info().fp64)
        REQUIRE(first("fabs(record.id - x)", {{"x", cl_double{209}}}) == 209);
    else
        REQUIRE_THROWS_AS(first("record.id - x", {{"x", cl_double{209}}}), Error);
}

TEST_CASE("another value of the same type compiles nothing") {
    const Device own = Device::choose();
    Lists<Point> lists(own, {point_cells});
    CELLIST_RANDOM(random, 192u);
    const Inserts<Point> inserts = point_inserts(random);
    Inserter(lists, own).build(lists, inserts);
    lists.sort_by(square_of_distance, {{"query", cl_float4{}}});
    require_order(lists, inserts, nearer_to(cl_float4{}));
    const std::size_t programs = own.state()->programs.size();
    for (int i = 0; i < 3; ++i) {
        const cl_float4 query{{static_cast<cl_float>(10 * i), 7, 0, 0}};
        lists.sort_by(square_of_distance, {{"query", query}});
        require_order(lists, inserts, nearer_to(query));
    }
    REQUIRE(own.state()->programs.size() == programs);
    // A value of another type does.
    lists.sort_by("record.id - scale", {{"scale", cl_int{1}}});
    const std::size_t more = own.state()->programs.size();
    REQUIRE(more > programs);
    lists.sort_by("record.id - scale", {{"scale", cl_float{1}}});
    REQUIRE(own.state()->programs.size() > more);
}

TEST_CASE("extreme values are passed on as they are") {
    Lists<Item> lists(device(), {3});
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 200; ++i) inserts.add(i % 2, {static_cast<cl_float>(i), i});
    Inserter(lists).build(lists, inserts);
    constexpr cl_float infinity = std::numeric_limits<cl_float>::infinity();
    constexpr cl_float nan = std::numeric_limits<cl_float>::quiet_NaN();
    // All keys are equal, so the members decide.
    for (const cl_float value : {nan, -nan, infinity, -infinity, 1e-40f}) {
        INFO(value);
        lists.sort_by("x", {{"x", value}}, Order::descending);
        require_sorted(lists.download(), oracle_of(inserts, 3), by_key);
    }
    // NaN comes last, even among infinities.
    lists.sort_by("record.id == y ? x : INFINITY", {{"x", nan}, {"y", cl_uint{40}}});
    REQUIRE(lists.download().cell(0).back().id == 40);
    lists.sort_by("record.id == 40 ? x : 0.0f", {{"x", -0.0f}});
    REQUIRE(lists.download().cell(0).front().id == 40);
    lists.sort_by("record.id ^ x", {{"x", ~cl_ulong{0}}});
    REQUIRE(lists.download().cell(0).front().id == 198);
}

TEST_CASE("invalid names and values are refused, and the message tells why") {
    for (const std::uint64_t extent : {0u, 3u}) {
        Lists<Item> lists(device(), {extent});
        const auto refusal = [&](const Values& values) {
            const std::string message =
                error_of([&] { lists.sort_by("record.id", values); }).what();
            REQUIRE(message ==
                    error_of([&] { lists.partial_sort_by("record.id", values, 3); }).what());
            REQUIRE(message == error_of([&] { lists.sort_by_async("record.id", values); }).what());
            return message;
        };
        for (const std::string name :
             {"", "1x", "a b", "a-b", "x;", "x)", "\xC3\xA4", "x\n", "*x", "a.b"}) {
            INFO(name);
            REQUIRE(contains(refusal({{name, 1.0f}}), "is called '" + name + "': use letters"));
        }
        for (const std::string name :
             {"record", "float", "uint4", "size_t", "kernel", "while", "cellist_sort_at",
              "CELLIST_RECORD", "__x", "barrier", "atomic_add", "vstore4"}) {
            INFO(name);
            REQUIRE(contains(refusal({{name, 1.0f}}), "'" + name + "', which is reserved"));
        }
        REQUIRE(contains(refusal({{"x", 1.0f}, {"y", 2.0f}, {"x", 3}}), "two values"));
        Values many;
        for (int i = 0; i < 33; ++i) many.emplace_back("x" + std::to_string(i), cl_float4{});
        REQUIRE(contains(refusal(many), "take 528 bytes, which exceeds the limit of 512"));
        many.pop_back();
        lists.sort_by("x31.x + x0.y", many);
    }
}

TEST_CASE("an expression that uses an unknown value does not compile") {
    Lists<Item> lists(device(), {3});
    const auto error = error_of<OpenClError>([&] {
        lists.sort_by("record.key * scal", {{"scale", 2.0f}});
    });
    REQUIRE(contains(error.log(), "scal"));
    REQUIRE(contains(error.log(), "sort expression"));
    lists.sort_by(std::string(64, ' ') + "scale", {{"scale", 2.0f}});
    REQUIRE(contains(error_of([&] {
                         lists.sort_by(std::string(65536, '(') + "scale", {{"scale", 2.0f}});
                     }).what(),
                     "65541 characters exceeds the limit"));
    // A name of any length, or one of a function, hides what else has this name.
    const std::string name(900, 'n');
    lists.sort_by("record.key * " + name, {{name, 2.0f}});
    lists.sort_by("record.key * distance", {{"distance", 2.0f}});
}

}  // namespace
}  // namespace cellist::test
