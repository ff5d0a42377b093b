// SPDX-License-Identifier: MIT
// The K records nearest to each of many queries, against a search of all records.
#include <cmath>
#include <limits>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

struct Photon {
    cl_float2 at;
    cl_uint id;
    cl_int power;
};
CELLIST_STRUCT(Photon, at, id, power);

/// A query of an adapted struct that the records do not contain.
struct Eye {
    cl_uint unused;
    cl_float x, y;
};
CELLIST_STRUCT(Eye, unused, x, y);

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Cells are 1 wide; coordinates are multiples of 1/8, so that many distances are equal.
struct Scene {
    std::array<cl_uint, 2> extent;
    std::array<bool, 4> periodic;
    Inserts<Photon> inserts = {};

    Scene(std::size_t count, std::array<cl_uint, 2> its_extent, std::array<bool, 4> is_periodic,
          std::mt19937& random)
        : extent(its_extent), periodic(is_periodic) {
        for (std::size_t i = 0; i < count; ++i) {
            const cl_uint x = below(random, 8 * extent[0]);
            const cl_uint y = below(random, 8 * extent[1]);
            inserts.add(y / 8 * extent[0] + x / 8,
                        {{{static_cast<cl_float>(x) / 8, static_cast<cl_float>(y) / 8}},
                         static_cast<cl_uint>(i / 2),
                         static_cast<cl_int>(below(random, 2)) - 1});
        }
    }

    [[nodiscard]] float square(const Photon& photon, const Eye& eye) const {
        const std::array d{photon.at.s[0] - eye.x, photon.at.s[1] - eye.y};
        float sum = 0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            float apart = std::fabs(d[axis]);
            const float box = static_cast<float>(extent[axis]);
            if (periodic[axis]) apart = std::fabs(std::remainder(apart, box));
            sum += apart * apart;
        }
        return sum;
    }

    [[nodiscard]] bool is_around(cl_uint cell, const Eye& eye, int radius) const {
        const std::array<double, 2> place{std::floor(static_cast<double>(eye.x)),
                                          std::floor(static_cast<double>(eye.y))};
        const std::array<cl_uint, 2> at{cell % extent[0], cell / extent[0]};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (!(std::fabs(place[axis]) < 2147483648.0)) return false;
            double apart = std::fabs(place[axis] - at[axis]);
            if (periodic[axis])
                apart = std::fabs(std::remainder(apart, static_cast<double>(extent[axis])));
            if (apart > radius) return false;
        }
        return true;
    }

    [[nodiscard]] std::vector<Photon> nearest(const Eye& eye, std::size_t k, float radius,
                                              int radius_cells) const {
        std::vector<Photon> all;
        for (std::size_t i = 0; i < inserts.size(); ++i)
            if (is_around(inserts.cells[i], eye, radius_cells) &&
                square(inserts.records[i], eye) <= radius)
                all.push_back(inserts.records[i]);
        std::sort(all.begin(), all.end(), [&](const Photon& a, const Photon& b) {
            return std::tuple(square(a, eye), a.at.s[0], a.at.s[1], a.id, a.power) <
                   std::tuple(square(b, eye), b.at.s[0], b.at.s[1], b.id, b.power);
        });
        all.resize(std::min(all.size(), k));
        return all;
    }
};

std::vector<Eye> some_eyes(const Scene& scene, std::mt19937& random) {
    std::vector<Eye> eyes{{0, 0, 0},         {0, nan, 1},  {0, 1, infinity},
                          {0, -0.5F, -0.5F}, {0, 1e4F, 0}, {0, -3e9F, 0}};
    for (int i = 0; i < 60; ++i)
        eyes.push_back({0, static_cast<cl_float>(below(random, 8 * (scene.extent[0] + 4))) / 8 - 2,
                        static_cast<cl_float>(below(random, 8 * (scene.extent[1] + 4))) / 8 - 2});
    return eyes;
}

constexpr auto distance_expression =
    "dot(cellist_minimum_image(record.at - (float2)(query.x, query.y), box), "
    "cellist_minimum_image(record.at - (float2)(query.x, query.y), box))";

NearestOptions options_of(const Scene& scene, std::uint32_t k, float radius,
                          std::uint32_t radius_cells) {
    const auto box = [&](std::size_t axis) {
        return scene.periodic[axis] ? static_cast<cl_float>(scene.extent[axis]) : 0;
    };
    return {.k = k,
            .position = "(float2)(query.x, query.y)",
            .distance = distance_expression,
            .radius = radius,
            .radius_cells = radius_cells,
            .values = {{"box", cl_float2{{box(0), box(1)}}}}};
}

void check_nearest(const Lists<Photon>& lists, const Scene& scene, const std::vector<Eye>& eyes,
                   std::uint32_t k, float radius, std::uint32_t radius_cells,
                   Nearest<Photon>& found) {
    INFO("k " << k << ", square of the radius " << radius << ", " << radius_cells << " cells");
    found = lists.nearest(Buffer<Eye>(device(), eyes), options_of(scene, k, radius, radius_cells),
                          std::move(found));
    const std::vector<cl_uint> counts = found.counts.download();
    const std::vector<Photon> records = found.records.download();
    const std::vector<cl_float> distances = found.distances.download();
    for (std::size_t q = 0; q < eyes.size(); ++q) {
        INFO("query at " << eyes[q].x << ", " << eyes[q].y);
        const std::vector<Photon> expected =
            scene.nearest(eyes[q], k, radius, static_cast<int>(radius_cells));
        REQUIRE(counts[q] == expected.size());
        for (std::size_t n = 0; n < expected.size(); ++n) {
            const Photon& photon = records[q * k + n];
            REQUIRE(distances[q * k + n] == scene.square(expected[n], eyes[q]));
            REQUIRE(photon.at.s[0] == expected[n].at.s[0]);
            REQUIRE(photon.at.s[1] == expected[n].at.s[1]);
            REQUIRE(photon.id == expected[n].id);
            REQUIRE(photon.power == expected[n].power);
        }
    }
}

TEST_CASE("the nearest records, with ties, fewer than k, and queries outside of the shape") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 500u);
    for (const std::array<bool, 4> periodic :
         {std::array<bool, 4>{}, std::array<bool, 4>{true, true}, std::array<bool, 4>{true}}) {
        for (const std::size_t count : {0U, 30U, 800U}) {
            const Scene scene(count, {6, 5}, periodic, random);
            Lists<Photon> lists(device(), {6, 5}, {.storage = storage, .periodic = periodic});
            Inserter<Photon>(lists).build(lists, scene.inserts);
            const std::vector<Eye> eyes = some_eyes(scene, random);
            Nearest<Photon> found;
            for (const std::uint32_t k : {1U, 64U, 7U, 0U, 50U})
                check_nearest(lists, scene, eyes, k, 1, 1, found);
            check_nearest(lists, scene, eyes, 33, 4, 2, found);
            check_nearest(lists, scene, eyes, 64, infinity, 2, found);
        }
    }
}

TEST_CASE("the lists of nearest(), and many records in one cell") {
    CELLIST_RANDOM(random, 501u);
    const Scene scene(5000, {1, 1}, {}, random);
    Lists<Photon> lists(device(), {1, 1}, {.storage = Storage::counted});
    Inserter<Photon>(lists).build(lists, scene.inserts);
    Nearest<Photon> found;
    check_nearest(lists, scene, some_eyes(scene, random), 64, 1, 1, found);
    check_nearest(lists, scene, {}, 64, 1, 1, found);

    const Scene few(30, {6, 5}, {}, random);
    Lists<Photon> kept(device(), {6, 5}, {.storage = nearest(&Photon::id, 40)});
    Inserter<Photon>(kept).build(kept, few.inserts);
    check_nearest(kept, few, some_eyes(few, random), 64, 1, 1, found);
}

TEST_CASE("a few queries among more records than are collected at once", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 503u);
    const Scene scene(330, {2, 1}, {true}, random);
    Lists<Photon> lists(device(), {2, 1}, {.storage = storage, .periodic = scene.periodic});
    Inserter<Photon>(lists).build(lists, scene.inserts);
    Nearest<Photon> found;
    check_nearest(lists, scene, {{0, 0.5F, 0.5F}, {0, -0.25F, -0.5F}, {0, nan, 0}}, 3, 4, 1, found);
}

TEST_CASE("queries that are scalars and vectors; distances that are NaN") {
    CELLIST_RANDOM(random, 502u);
    const Scene scene(200, {6, 5}, {}, random);
    Lists<Photon> lists(device(), {6, 5}, {.storage = Storage::counted});
    Inserter<Photon>(lists).build(lists, scene.inserts);
    // Components of the position beyond the shape's dimensions have no effect.
    const Buffer<cl_float4> vectors(device(), std::vector<cl_float4>{{{2.5F, 2.5F, 77, nan}}});
    NearestOptions options{
        .k = 5, .position = "query", .distance = "distance(record.at, query.xy)", .radius = 1};
    const std::vector<Photon> expected = scene.nearest({0, 2.5F, 2.5F}, 5, 1, 1);
    const Nearest<Photon> found = lists.nearest(vectors, options);
    REQUIRE(found.counts.download() == std::vector<cl_uint>{static_cast<cl_uint>(expected.size())});
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(found.records.download()[i].id == expected[i].id);

    // A position may be of doubles or unsigned integers.
    for (const char* position : {"convert_uint2(query.xy)", "convert_double2(query.xy)"}) {
        if (!device().info().fp64 && std::string_view(position).find("double") != std::string::npos)
            continue;
        NearestOptions other = options;
        other.position = position;
        CHECK(lists.nearest(vectors, other).counts.download() == found.counts.download());
    }

    const Buffer<cl_int> scalars(device(), std::vector<cl_int>{0, 3, -1, -2});
    const Nearest<Photon> above = lists.nearest(
        scalars,
        {.k = 64, .position = "query", .distance = "record.at.y < 1 ? 1.0f : NAN", .radius = 1});
    const std::vector<cl_uint> counts = above.counts.download();
    for (std::size_t q = 0; q < 4; ++q) {
        const int x = std::array{0, 3, -1, -2}[q];
        std::size_t inside = 0;
        for (const Photon& photon : scene.inserts.records)
            if (photon.at.s[1] < 1 && std::fabs(std::floor(photon.at.s[0]) - float(x)) <= 1)
                ++inside;
        CHECK(counts[q] == std::min<std::size_t>(inside, 64));
    }
}

TEST_CASE("k of 65, invalid expressions and values") {
    const Lists<Photon> lists(device(), {4, 4});
    const Buffer<cl_float2> queries(device(), 3);
    const auto refused = [&](const NearestOptions& options) {
        return std::string(error_of([&] { (void)lists.nearest(queries, options); }).what());
    };
    CHECK(contains(refused({.k = 65, .position = "query", .distance = "1"}), "limit of 64"));
    CHECK(contains(refused({.position = "query", .distance = "record.id++"}), "'++'"));
    CHECK(contains(refused({.position = "", .distance = "1"}), "position expression is empty"));
    CHECK(
        contains(refused({.position = "query", .distance = " "}), "distance expression is empty"));
    CHECK(contains(refused({.position = "*query", .distance = "1"}), "pointer"));
    CHECK(contains(refused({.position = "query", .distance = "1", .values = {{"query", 1.0F}}}),
                   "reserved"));
    CHECK(contains(refused({.position = "query.nothing", .distance = "1"}), "position expression"));
}

}  // namespace
}  // namespace cellist::test
