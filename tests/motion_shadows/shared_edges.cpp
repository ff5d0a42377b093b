// SPDX-License-Identifier: MIT
// Triangles that share a moving edge: exactly one of them covers a place near the edge at each
// time. Their ranges neither overlap nor leave a gap.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/oracle.hpp"
#include "support/random.hpp"
#include "support/random_scenes.hpp"
#include "support/range_map.hpp"

namespace cellist::test {
namespace {

constexpr std::size_t times_of_a_triangle = 12;

// Of each triangle: changes of the shared edge, its side, number of ranges, and up to 4 ranges.
// The shared edge is opposite of the corner that `apexes` names.
const std::string kernel_text = R"(
kernel void find_times(global const MovingVertex* vertices, global const uint* indices,
                       global const uint* apexes, global const float2* places, uint count,
                       global float* times) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    MovingTriangle t;
    triangle_load(&t, vertices, indices, i);
    global float* out = times + 12 * i;
    VisibleTimes visible;
    for (int k = 0; k < 12; ++k) out[k] = -1.0f;
    const int is_visible = visible_begin(&visible, &t, places[i / 2]);
    const EdgeTimes edge = triangle_edge_times(&t, places[i / 2], apexes[i]);
    out[0] = edge.first;
    out[1] = edge.second;
    out[2] = (float)edge.positive;
    uint ranges = 0;
    float2 range;
    while (is_visible && visible_next(&visible, &range)) {
        if (ranges < 4) vstore2(range, 0, out + 4 + 2 * ranges);
        ++ranges;
    }
    out[3] = (float)ranges;
}
)";

// A vertex at these places in pixels and these depths.
motion::MovingVertex vertex(const glm::dvec2& begin, const glm::dvec2& end, double w_begin = 1,
                            double w_end = 1) {
    const auto wide = [](const glm::dvec2& p, double w) {
        return cl_float4{{static_cast<cl_float>(p.x * w), static_cast<cl_float>(p.y * w),
                          static_cast<cl_float>(w), static_cast<cl_float>(w)}};
    };
    return {wide(begin, w_begin), wide(end, w_end)};
}

// Two triangles on the two sides of an edge.
struct Pair {
    std::array<motion::MovingVertex, 2> edge;
    std::array<motion::MovingVertex, 2> apex;
    cl_float2 place;
};

class EdgeTimes {
public:
    EdgeTimes()
        : kernel_(motion::moving_kernel(
              device(), std::string(motion::kernels::exact_clh) + kernel_text, "find_times")) {}

    // 12 numbers for each of the two triangles of each pair.
    std::vector<cl_float> of(const std::vector<Pair>& pairs, std::mt19937& random) {
        std::vector<motion::MovingVertex> vertices;
        std::vector<cl_uint> indices, apexes;
        std::vector<cl_float2> places;
        for (const Pair& pair : pairs) {
            const auto first = static_cast<cl_uint>(vertices.size());
            vertices.insert(vertices.end(), {pair.edge[0], pair.edge[1], pair.apex[0], pair.edge[1],
                                             pair.edge[0], pair.apex[1]});
            // The second triangle has copies of the vertices, or the same ones.
            const bool has_copies = random() % 2 == 0;
            const std::array<std::array<cl_uint, 3>, 2> corners{
                {{first, first + 1, first + 2},
                 {first + (has_copies ? 3 : 1), first + (has_copies ? 4 : 0), first + 5}}};
            for (const auto& c : corners) {
                // The apex comes at any corner.
                const auto turn = static_cast<cl_uint>(random() % 3);
                for (cl_uint k = 0; k < 3; ++k) indices.push_back(c[(k + turn) % 3]);
                apexes.push_back((2 + 3 - turn) % 3);
            }
            places.push_back(pair.place);
        }
        return of(vertices, indices, apexes, places);
    }

    // Of any triangles, two for each place.
    std::vector<cl_float> of(const std::vector<motion::MovingVertex>& vertices,
                             const std::vector<cl_uint>& indices,
                             const std::vector<cl_uint>& apexes,
                             const std::vector<cl_float2>& places) {
        const auto count = static_cast<cl_uint>(apexes.size());
        Buffer<cl_float> times(device(), times_of_a_triangle * count);
        kernel_.run(Range::padded(count, 64), Buffer(device(), vertices), Buffer(device(), indices),
                    Buffer(device(), apexes), Buffer(device(), places), count, times);
        return times.download();
    }

private:
    Kernel kernel_;
};

// Whether both triangles agree about their shared edge.
bool agree(const cl_float* a, const cl_float* b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] + b[2] == 1;
}

// Whether the ranges of triangles, one after the other, are the exposure.
bool cover_exposure(const cl_float* triangles, std::size_t count) {
    std::vector<std::pair<cl_float, cl_float>> ranges;
    for (std::size_t i = 0; i < count; ++i) {
        const cl_float* times = triangles + i * times_of_a_triangle;
        const auto of_this = static_cast<std::size_t>(times[3]);
        if (of_this > 4) return false;
        for (std::size_t k = 0; k < of_this; ++k)
            ranges.emplace_back(times[4 + 2 * k], times[5 + 2 * k]);
    }
    std::sort(ranges.begin(), ranges.end());
    cl_float reached = 0;
    for (const auto& [begin, end] : ranges) {
        if (begin != reached || !(end > begin)) return false;
        reached = end;
    }
    return reached == 1;
}

struct Disagreements {
    std::size_t edges = 0, exposures = 0, with_changes = 0;
};

template <class MakePair>
Disagreements try_pairs(std::size_t count, std::mt19937& random, const MakePair& make_pair) {
    EdgeTimes edge_times;
    Disagreements found;
    constexpr std::size_t batch = 100'000;
    for (std::size_t first = 0; first < count; first += batch) {
        std::vector<Pair> pairs(std::min(batch, count - first));
        for (Pair& pair : pairs) pair = make_pair();
        const std::vector<cl_float> times = edge_times.of(pairs, random);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const cl_float* a = &times[2 * i * times_of_a_triangle];
            const cl_float* b = a + times_of_a_triangle;
            if (!agree(a, b)) ++found.edges;
            if (!cover_exposure(a, 2)) ++found.exposures;
            if (a[0] < 1) ++found.with_changes;
        }
    }
    return found;
}

glm::dvec2 place_of(const Pair& pair) { return {pair.place.s[0], pair.place.s[1]}; }

cl_float2 random_texel(std::mt19937& random) {
    return {{static_cast<cl_float>(below(random, 1024)) - 511.5F,
             static_cast<cl_float>(below(random, 1024)) - 511.5F}};
}

double log_uniform(std::mt19937& random, double low, double high) {
    return std::exp(between(random, std::log(low), std::log(high)));
}

// An edge that crosses the place or passes near it, in the middle of a quadrilateral.
Pair random_pair(std::mt19937& random, bool is_parallel) {
    Pair pair;
    pair.place = random_texel(random);
    const double angle = between(random, 0, 6.283);
    const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
    // How far the edge is from the place and how far its ends move.
    const double way = log_uniform(random, 1e-6, 30), slide = log_uniform(random, 1e-3, 30);
    for (int k = 0; k < 2; ++k) {
        const double sign = k == 0 ? -1 : 1;
        const double length = sign * between(random, 40, 200);
        pair.edge[std::size_t(k)] =
            vertex(place_of(pair) + length * along + between(random, -way, way) * across,
                   place_of(pair) + (length + between(random, -slide, slide)) * along +
                       between(random, -way, way) * across,
                   is_parallel ? 1 : log_uniform(random, 0.5, 8),
                   is_parallel ? 1 : log_uniform(random, 0.5, 8));
        const auto apex = [&] {
            return place_of(pair) + sign * between(random, 100, 300) * across +
                   between(random, -10, 10) * along;
        };
        pair.apex[std::size_t(k)] =
            vertex(apex(), apex(), is_parallel ? 1 : 3, is_parallel ? 1 : 2);
    }
    return pair;
}

TEST_CASE("one of two triangles covers a place near their moving edge at each time") {
    for (const bool is_parallel : {false, true}) {
        INFO((is_parallel ? "parallel" : "perspective"));
        CELLIST_RANDOM(random, 2);
        const Disagreements found =
            try_pairs(500'000, random, [&] { return random_pair(random, is_parallel); });
        CHECK(found.edges == 0);
        CHECK(found.exposures == 0);
        CHECK(found.with_changes > 100'000);
    }
}

TEST_CASE("triangles agree about any edge that they share, also behind the light") {
    CELLIST_RANDOM(random, 3);
    const Disagreements found = try_pairs(300'000, random, [&] {
        Pair pair;
        pair.place = random_texel(random);
        const double size = log_uniform(random, 1e-3, 1e6);
        const auto any = [&] {
            const auto p = [&] {
                return place_of(pair) +
                       glm::dvec2(between(random, -size, size), between(random, -size, size));
            };
            return vertex(p(), p(), between(random, -4, 4), between(random, -4, 4));
        };
        pair.edge = {any(), any()};
        pair.apex = {any(), any()};
        return pair;
    });
    CHECK(found.edges == 0);
}

TEST_CASE("edges that always run through the place belong to one triangle") {
    // Coordinates are whole, so that edges meet the place exactly; ends move along the edge.
    CELLIST_RANDOM(random, 4);
    const Disagreements found = try_pairs(300'000, random, [&] {
        Pair pair;
        pair.place = random_texel(random);
        glm::dvec2 step;
        do {
            step = {double(below(random, 9)) - 4, double(below(random, 9)) - 4};
        } while (step == glm::dvec2(0));
        const bool moves = random() % 2 == 0;
        for (std::size_t k = 0; k < 2; ++k) {
            const double sign = k == 0 ? -1 : 1;
            const double begin = 1 + below(random, 7);
            const double end = moves ? 1 + below(random, 7) : begin;
            const double w = random() % 2 == 0 ? 1 : 4;
            pair.edge[k] = vertex(place_of(pair) + sign * begin * step,
                                  place_of(pair) + sign * end * step, w, moves ? 2 : w);
            const glm::dvec2 apex = place_of(pair) + sign * 64.0 * glm::dvec2(-step.y, step.x);
            pair.apex[k] = vertex(apex, apex);
        }
        return pair;
    });
    CHECK(found.edges == 0);
    CHECK(found.exposures == 0);
    CHECK(found.with_changes == 0);
}

TEST_CASE("an edge that turns about the place, or only touches it, leaves no gap") {
    CELLIST_RANDOM(random, 5);
    const Disagreements found = try_pairs(100'000, random, [&] {
        Pair pair;
        pair.place = random_texel(random);
        // Touches at a random time: the distance is that of a square.
        const double t = below(random, 5) / 4.0;
        const double a = 16, slope = 1 + below(random, 4);
        const glm::dvec2 p = place_of(pair);
        // Ends at x = -a and a, y = slope * (time - t) or the opposite: turns about the place.
        const bool turns = random() % 2 == 0;
        const double other = turns ? -1 : 1;
        pair.edge = {vertex(p + glm::dvec2(-a, -slope * t), p + glm::dvec2(-a, slope * (1 - t))),
                     vertex(p + glm::dvec2(a, -other * slope * t),
                            p + glm::dvec2(a, other * slope * (1 - t)))};
        pair.apex = {vertex(p + glm::dvec2(0, -64), p + glm::dvec2(0, -64)),
                     vertex(p + glm::dvec2(0, 64), p + glm::dvec2(0, 64))};
        return pair;
    });
    CHECK(found.edges == 0);
    CHECK(found.exposures == 0);
}

TEST_CASE("of the triangles around a vertex that stays on the place, one covers it") {
    CELLIST_RANDOM(random, 14);
    constexpr std::size_t fans = 50'000, triangles = 6;
    std::vector<motion::MovingVertex> vertices;
    std::vector<cl_uint> indices;
    std::vector<cl_float2> places;
    for (std::size_t i = 0; i < fans; ++i) {
        const cl_float2 place = random_texel(random);
        const glm::dvec2 centre(place.s[0], place.s[1]);
        const auto first = static_cast<cl_uint>(vertices.size());
        vertices.push_back(vertex(centre, centre));
        const bool moves = random() % 4 != 0;
        for (std::size_t k = 0; k < triangles; ++k) {
            const auto rim = [&] {
                const double angle = 1.047198 * (double(k) + between(random, -0.3, 0.3));
                return centre +
                       between(random, 5, 50) * glm::dvec2(std::cos(angle), std::sin(angle));
            };
            const glm::dvec2 begin = rim();
            vertices.push_back(vertex(begin, moves ? rim() : begin));
            const auto a = first + 1 + static_cast<cl_uint>(k);
            const auto b = first + 1 + static_cast<cl_uint>((k + 1) % triangles);
            indices.insert(indices.end(), {first, a, b});
            if (k % 2 == 0) places.push_back(place);
        }
    }
    const std::vector<cl_float> times =
        EdgeTimes().of(vertices, indices, std::vector<cl_uint>(fans * triangles), places);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < fans; ++i)
        if (!cover_exposure(&times[i * triangles * times_of_a_triangle], triangles)) ++wrong;
    CHECK(wrong == 0);
}

}  // namespace
}  // namespace cellist::test
