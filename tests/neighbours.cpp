// SPDX-License-Identifier: MIT
// The neighbours of all records, against a comparison of all pairs.
#include <cmath>
#include <limits>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

struct Dot {
    cl_float x, y, z;
    cl_uint id;
    friend bool operator==(const Dot&, const Dot&) = default;
};
CELLIST_STRUCT(Dot, x, y, z, id);

/// Space: one cell is 1 wide, and coordinates are multiples of 1/16, so that squares are exact.
struct Space {
    std::array<cl_uint, 3> extent{1, 1, 1};
    std::array<bool, 4> periodic{};

    [[nodiscard]] Shape shape() const { return {extent[0], extent[1], extent[2]}; }
    [[nodiscard]] cl_float box(std::size_t axis) const {
        return periodic[axis] ? static_cast<cl_float>(extent[axis]) : 0;
    }
    [[nodiscard]] float square(const Dot& a, const Dot& b) const {
        const std::array d{a.x - b.x, a.y - b.y, a.z - b.z};
        float sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float apart = std::fabs(d[axis]);
            if (periodic[axis]) apart = std::min(apart, box(axis) - apart);
            sum += apart * apart;
        }
        return sum;
    }
    [[nodiscard]] cl_uint cell(const Dot& dot) const {
        return (static_cast<cl_uint>(dot.z) * extent[1] + static_cast<cl_uint>(dot.y)) * extent[0] +
               static_cast<cl_uint>(dot.x);
    }
};

Inserts<Dot> random_dots(std::size_t count, const Space& space, std::mt19937& random) {
    Inserts<Dot> inserts;
    for (std::size_t i = 0; i < count; ++i) {
        const auto coordinate = [&](std::size_t axis) {
            return static_cast<cl_float>(below(random, 16 * space.extent[axis])) / 16;
        };
        const Dot dot{coordinate(0), coordinate(1), coordinate(2), static_cast<cl_uint>(i)};
        inserts.add(space.cell(dot), dot);
    }
    return inserts;
}

NeighbourOptions options_of(const Space& space, float square) {
    return {.distance =
                "dot(cellist_minimum_image((float4)(record.x - other.x, record.y - "
                "other.y, record.z - other.z, 0.0f), box), "
                "cellist_minimum_image((float4)(record.x - other.x, record.y - other.y, "
                "record.z - other.z, 0.0f), box))",
            .radius = square,
            .radius_cells = static_cast<cl_uint>(std::ceil(std::sqrt(square))),
            .values = {{"box", cl_float4{{space.box(0), space.box(1), space.box(2), 0}}}}};
}

/// The rows of a result, each in ascending order.
std::vector<std::vector<cl_uint>> rows_of(const Neighbours& found) {
    const std::vector<cl_uint> offsets = found.offsets.download();
    const std::vector<cl_uint> indices = found.indices.download();
    REQUIRE(offsets.size() >= found.records + 1);
    REQUIRE(indices.size() >= found.pairs);
    REQUIRE(offsets[0] == 0);
    REQUIRE(offsets[found.records] == found.pairs);
    std::vector<std::vector<cl_uint>> rows;
    for (std::size_t i = 0; i < found.records; ++i) {
        REQUIRE(offsets[i] <= offsets[i + 1]);
        rows.emplace_back(indices.begin() + offsets[i], indices.begin() + offsets[i + 1]);
        std::sort(rows.back().begin(), rows.back().end());
    }
    return rows;
}

/// Compares with all pairs of the records in the order of pack().
template <class IsNear>
void require_neighbours(const Lists<Dot>& lists, const Neighbours& by_place,
                        const Neighbours& by_id, const IsNear& is_near) {
    const std::vector<Dot> dots = lists.pack().records.download();
    REQUIRE(by_place.records == dots.size());
    const auto places = rows_of(by_place);
    const auto ids = rows_of(by_id);
    for (std::size_t i = 0; i < dots.size(); ++i) {
        std::vector<cl_uint> expected_places, expected_ids;
        for (std::size_t j = 0; j < dots.size(); ++j)
            if (i != j && is_near(dots[i], dots[j])) {
                expected_places.push_back(static_cast<cl_uint>(j));
                expected_ids.push_back(dots[j].id);
            }
        std::sort(expected_ids.begin(), expected_ids.end());
        REQUIRE(places[i] == expected_places);
        REQUIRE(ids[i] == expected_ids);
    }
}

void check_neighbours(Lists<Dot>& lists, const Space& space, float square, Neighbours& by_place,
                      Neighbours& by_id) {
    INFO("shape " << space.shape().to_string() << ", square of the radius " << square);
    const NeighbourOptions options = options_of(space, square);
    by_place = lists.neighbours(options, std::move(by_place));
    by_id = lists.neighbours(&Dot::id, options, std::move(by_id));
    require_neighbours(lists, by_place, by_id,
                       [&](const Dot& a, const Dot& b) { return space.square(a, b) <= square; });
}

TEST_CASE("all pairs in open and periodic space, with the same buffers in every step") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 400u);
    for (const Space& space : {Space{{6, 5, 4}, {}}, Space{{6, 5, 4}, {true, true, true}},
                               Space{{7, 3, 1}, {true, false, false}}, Space{{40, 1, 1}, {}}}) {
        Lists<Dot> lists(device(), space.shape(), {.storage = storage, .periodic = space.periodic});
        Inserter<Dot> inserter(lists);
        Neighbours by_place, by_id;
        for (const std::size_t count : {7U, 300U, 0U, 1U, 93U, 144U}) {
            inserter.build(lists, random_dots(count, space, random));
            for (const float square : {0.25F, 1.0F, 2.25F})
                check_neighbours(lists, space, square, by_place, by_id);
        }
    }
}

TEST_CASE("a few records", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 405u);
    const Space space{{4, 2, 1}, {true, false, false}};
    Lists<Dot> lists(device(), space.shape(), {.storage = storage, .periodic = space.periodic});
    Inserter<Dot>(lists).build(lists, random_dots(40, space, random));
    Neighbours by_place, by_id;
    check_neighbours(lists, space, 1, by_place, by_id);
}

TEST_CASE("the first search takes exactly the memory that the pairs need") {
    CELLIST_RANDOM(random, 401u);
    const Space space{{4, 4, 4}, {true, true, true}};
    Lists<Dot> lists(device(), space.shape(), {.periodic = space.periodic});
    Inserter<Dot>(lists).build(lists, random_dots(500, space, random));
    const Neighbours found = lists.neighbours(options_of(space, 1));
    REQUIRE(found.pairs > 0);
    CHECK(found.indices.size() == found.pairs);
    CHECK(found.offsets.size() == 501);
}

TEST_CASE("more candidates around a cell than a work-item compares at once") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 402u);
    const Space space{{2, 2, 1}, {}};
    Lists<Dot> lists(device(), space.shape(), {.storage = storage});
    Inserter<Dot>(lists).build(lists, random_dots(1000, space, random));
    Neighbours by_place, by_id;
    check_neighbours(lists, space, 0.5F, by_place, by_id);
}

TEST_CASE("sorted lists, and lists that dropped records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 403u);
    const Space space{{4, 4, 1}, {}};
    Lists<Dot> lists(
        device(), space.shape(),
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 150, .slots = 9});
    Inserter<Dot>(lists).build(lists, random_dots(300, space, random));
    Neighbours by_place, by_id;
    check_neighbours(lists, space, 1, by_place, by_id);
    lists.sort(&Dot::id);
    check_neighbours(lists, space, 1, by_place, by_id);
    lists.clear();
    check_neighbours(lists, space, 1, by_place, by_id);
}

TEST_CASE("distances that are NaN, infinite, or depend on the order of the records") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 404u);
    const Space space{{3, 3, 3}, {}};
    Lists<Dot> lists(device(), space.shape(), {.storage = storage});
    Inserter<Dot>(lists).build(lists, random_dots(100, space, random));
    const auto check = [&](const NeighbourOptions& options, auto is_near) {
        require_neighbours(lists, lists.neighbours(options), lists.neighbours(&Dot::id, options),
                           is_near);
    };
    check({.distance = "nan(0u)", .radius_cells = 3}, [](auto&, auto&) { return false; });
    check({.distance = "INFINITY", .radius = 1e30F, .radius_cells = 3},
          [](auto&, auto&) { return false; });
    check({.distance = "INFINITY", .radius_cells = 3}, [](auto&, auto&) { return true; });
    check({.distance = "record.id < other.id ? 0 : 1", .radius = 0, .radius_cells = 3},
          [](const Dot& a, const Dot& b) { return a.id < b.id; });
    check({.distance = "0", .radius = std::numeric_limits<float>::quiet_NaN()},
          [](auto&, auto&) { return false; });
}

struct Large {
    cl_float x;
    cl_uint id;
    cl_float4 rest[40];
};
CELLIST_STRUCT(Large, x, id, rest);

TEST_CASE("large records") {
    CELLIST_EACH_STORAGE(storage);
    Inserts<Large> inserts;
    for (cl_uint i = 0; i < 100; ++i) {
        Large large{};
        large.x = static_cast<cl_float>(i) / 10;
        large.id = i;
        inserts.add(i / 10, large);
    }
    Lists<Large> lists(device(), {10}, {.storage = storage});
    Inserter<Large>(lists).build(lists, inserts);
    lists.sort(&Large::id);
    const auto rows =
        rows_of(lists.neighbours({.distance = "fabs(record.x - other.x)", .radius = 0.15F}));
    REQUIRE(rows.size() == 100);
    for (cl_uint i = 0; i < 100; ++i) CHECK(rows[i].size() == (i == 0 || i == 99 ? 1 : 2));
}

TEST_CASE("invalid expressions and values") {
    const Lists<Dot> lists(device(), {4});
    const auto refused = [&](const NeighbourOptions& options) {
        return std::string(error_of([&] { (void)lists.neighbours(options); }).what());
    };
    CHECK(contains(refused({.distance = "record.x = 1"}), "'='"));
    CHECK(contains(refused({.distance = "1", .values = {{"other", 1}}}), "reserved"));
    CHECK(contains(refused({.distance = "1", .values = {{"record", 1}}}), "reserved"));
    CHECK(contains(refused({.distance = "cellist_distance(0, 0)"}), "cellist_distance"));
    CHECK(contains(refused({.distance = "record.nothing"}), "distance expression"));
}

}  // namespace
}  // namespace cellist::test
