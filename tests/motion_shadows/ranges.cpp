// SPDX-License-Identifier: MIT
// The light's ray through a texel meets the prism of a moving triangle an even number of times, and
// pairs of these fragments are depth-time ranges.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "method.hpp"
#include "motion_kernels.hpp"
#include "renderer.hpp"
#include "sides.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

using motion::DepthTimeRange;
using motion::MovingVertex;
using motion::PrismFragment;

// ---- prisms in the image of a light

constexpr int map_side = 128;
constexpr std::size_t texel_count = map_side * map_side;

using Prism = std::array<MovingVertex, 3>;

double uniform(std::mt19937& random, double low, double high) {
    return low + (high - low) * (double(random()) / 4294967296.0);
}

// x * w, y * w, w, depth
cl_float4 vertex(const glm::dvec2& image, double w, double depth) {
    return {{cl_float(image.x * w), cl_float(image.y * w), cl_float(w), cl_float(depth)}};
}

enum class Kind {
    any,
    small_turn,
    crossing,
    translation,
    still,
    hinge,
    collapsing,
    aligned,
    count
};

// A triangle in a square of 8 texels.
Prism random_prism(std::mt19937& random, Kind kind, bool is_parallel) {
    const glm::dvec2 centre(uniform(random, -50, 50), uniform(random, -50, 50));
    const double depth = uniform(random, 2, 8);
    const auto draw = [&] {
        glm::dvec2 image = centre + glm::dvec2(uniform(random, -4, 4), uniform(random, -4, 4));
        if (kind == Kind::aligned) image = glm::floor(image) + 0.5 * double(below(random, 2));
        const double own = depth + uniform(random, -0.5, 0.5);
        return vertex(image, is_parallel ? 1 : own, own);
    };
    Prism prism;
    for (MovingVertex& v : prism) v = {draw(), draw()};
    const cl_float4 first = prism[0].begin, last = prism[0].end;
    for (std::size_t k = 0; k < 3; ++k) {
        MovingVertex& v = prism[k];
        for (int c = 0; c < 4; ++c) {
            const cl_float way = last.s[c] - first.s[c];
            if (kind == Kind::translation) v.end.s[c] = v.begin.s[c] + way;
            if (kind == Kind::small_turn)
                v.end.s[c] = v.begin.s[c] + 0.05F * (v.end.s[c] - v.begin.s[c]);
        }
        if (kind == Kind::still || (kind == Kind::hinge && k < 2)) v.end = v.begin;
        if (kind == Kind::collapsing) v.end = k < 2 ? last : v.end;
    }
    if (kind == Kind::crossing) std::swap(prism[0].end, prism[1].end);
    return prism;
}

std::vector<Prism> prisms_of(std::mt19937& random, Kind kind, std::size_t count, bool is_parallel) {
    std::vector<Prism> prisms;
    for (std::size_t i = 0; i < count; ++i)
        prisms.push_back(random_prism(random, kind, is_parallel));
    return prisms;
}

// Of all kinds.
std::vector<Prism> random_prisms(std::mt19937& random, std::size_t count, bool is_parallel) {
    std::vector<Prism> prisms;
    for (std::size_t i = 0; i < count; ++i)
        prisms.push_back(
            random_prism(random, static_cast<Kind>(i % std::size_t(Kind::count)), is_parallel));
    return prisms;
}

motion::View light_of(bool is_parallel) {
    motion::View view{};
    view.near_depth = 0.25F;
    view.pixel = is_parallel ? 1.0F : 1.0F / map_side;
    view.is_parallel = is_parallel ? 1U : 0U;
    view.width = view.height = map_side;
    return view;
}

glm::dvec2 texel_centre(std::size_t texel) {
    return {double(texel % map_side) + 0.5 - 0.5 * map_side,
            double(texel / map_side) + 0.5 - 0.5 * map_side};
}

std::vector<std::size_t> texels_between(const glm::dvec2& low, const glm::dvec2& high) {
    std::vector<std::size_t> found;
    for (double y = std::floor(low.y) + 0.5; y <= high.y; ++y)
        for (double x = std::floor(low.x) + 0.5; x <= high.x; ++x)
            found.push_back(static_cast<std::size_t>((y + 0.5 * map_side - 0.5) * map_side + x +
                                                     0.5 * map_side));
    return found;
}

// Only the numbers of vertices and triangles matter: the vertices in the image are given.
motion::Scene scene_of(std::size_t prisms) {
    motion::Scene scene;
    scene.begin.resize(3 * prisms);
    scene.end.resize(3 * prisms);
    scene.colours.resize(prisms);
    for (std::uint32_t i = 0; i < prisms; ++i)
        scene.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    return scene;
}

BuildReport make_ranges(Lists<DepthTimeRange>& ranges, Lists<PrismFragment>& fragments) {
    fragments.sort(&PrismFragment::triangle);
    Kernel pair = motion::moving_kernel(device(), motion::kernels::pair_ranges_cl, "pair_fragments",
                                        ranges, fragments);
    const std::uint64_t texels = fragments.shape().cells();
    return ranges.build(pair, Range::padded(texels, 64), fragments, cl_uint(texels));
}

// What the kernels make from prisms.
struct Swept {
    Swept(const std::vector<Prism>& prisms, bool is_parallel)
        : scene(device(), scene_of(prisms.size())),
          light(device(), scene_of(prisms.size()), light_of(is_parallel)),
          farthest(device(), texel_count),
          fragments(device(), {texel_count}),
          ranges(device(), {texel_count}) {
        std::vector<MovingVertex> vertices;
        for (const Prism& prism : prisms)
            vertices.insert(vertices.end(), prism.begin(), prism.end());
        light.vertices.upload_async(vertices).wait();
        light.sides.fill(motion::both_sides);
        farthest.fill(std::numeric_limits<cl_float>::infinity());
        motion::Sweep sweep(device(), motion::kernels::sweep_prism_cl, fragments);
        fragments_report = fragments.build([&] { sweep.run(scene, light, fragments, farthest); });
        ranges_report = make_ranges(ranges, fragments);
    }

    motion::SceneBuffers scene;
    motion::SeenScene light;
    Buffer<cl_float> farthest;
    Lists<PrismFragment> fragments;  ///< sorted by triangle
    Lists<DepthTimeRange> ranges;
    BuildReport fragments_report, ranges_report;
};

// Calls f(texel, triangle, records) for all records of a triangle in a texel.
template <class T, class F>
void for_each_prism(const HostLists<T>& lists, F f) {
    for (std::size_t texel = 0; texel < lists.cells(); ++texel) {
        std::vector<T> list(lists.cell(texel).begin(), lists.cell(texel).end());
        std::stable_sort(list.begin(), list.end(),
                         [](const T& a, const T& b) { return a.triangle < b.triangle; });
        for (std::size_t i = 0, end; i < list.size(); i = end) {
            end = i + 1;
            while (end < list.size() && list[end].triangle == list[i].triangle) ++end;
            f(texel, list[i].triangle, std::span(list).subspan(i, end - i));
        }
    }
}

// ---- the facets of the paper, in double precision

struct Corner {
    glm::dvec4 at;
    double time;
};

glm::dvec4 double4(const cl_float4& v) { return {v.s[0], v.s[1], v.s[2], v.s[3]}; }

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Where the images of two edges cross, as parts of both.
glm::dvec2 crossing(const Corner (&quad)[4]) {
    const auto image = [&](std::size_t k) { return glm::dvec2(quad[k].at) / quad[k].at.z; };
    const glm::dvec2 ab = image(1) - image(0), cd = image(2) - image(3), ac = image(3) - image(0);
    return glm::dvec2(cross(ac, cd), cross(ac, ab)) / cross(ab, cd);
}

// The point of an edge whose image is at a part of the edge's image.
glm::dvec4 at_image(const glm::dvec4& a, const glm::dvec4& b, double part) {
    const double u = part / b.z / ((1 - part) / a.z + part / b.z);
    return glm::mix(a, b, u);
}

// Empty where rounding may decide whether edges cross.
std::optional<std::vector<std::array<Corner, 3>>> facets_of(const Prism& prism) {
    std::vector<std::array<Corner, 3>> facets;
    std::array<Corner, 3> first, last;
    for (std::size_t k = 0; k < 3; ++k) {
        first[k] = {double4(prism[k].begin), 0};
        last[k] = {double4(prism[k].end), 1};
    }
    facets = {first, last};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const Corner quad[4] = {first[k], first[next], last[next], last[k]};
        const bool share_an_end = quad[0].at == quad[3].at || quad[1].at == quad[2].at;
        const glm::dvec2 parts = share_an_end ? glm::dvec2(-1) : crossing(quad);
        const glm::dvec2 low = glm::min(parts, 1.0 - parts);
        if (std::abs(std::min(low.x, low.y)) < 1e-4) return {};
        if (std::min(low.x, low.y) > 0) {
            const Corner x{0.5 * (at_image(quad[0].at, quad[1].at, parts.x) +
                                  at_image(quad[3].at, quad[2].at, parts.y)),
                           0.5};
            facets.push_back({quad[0], quad[3], x});
            facets.push_back({quad[1], quad[2], x});
        } else {
            const Corner centre{0.25 * (quad[0].at + quad[1].at + quad[2].at + quad[3].at), 0.5};
            for (std::size_t j = 0; j < 4; ++j)
                facets.push_back({quad[j], quad[(j + 1) % 4], centre});
        }
    }
    return facets;
}

// Fragments ordered by time. Empty where rounding may decide whether a facet is hit.
std::optional<std::vector<glm::dvec2>> times_and_depths(
    const std::vector<std::array<Corner, 3>>& facets, const glm::dvec2& place) {
    std::vector<glm::dvec2> found;
    for (const auto& facet : facets) {
        glm::dvec2 v[3];
        for (std::size_t k = 0; k < 3; ++k) v[k] = glm::dvec2(facet[k].at) / facet[k].at.z - place;
        const double area = cross(v[1] - v[0], v[2] - v[0]);
        double weight[3], least = 1e9, longest = 0, sum = 0, time = 0, depth = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2 a = v[(k + 1) % 3], b = v[(k + 2) % 3];
            weight[k] = cross(a, b) * (area < 0 ? -1 : 1);
            longest = std::max(longest, glm::distance(a, b));
            if (a != b) least = std::min(least, weight[k] / glm::distance(a, b));
        }
        // Facets that are nearly seen from their edge have steep times and depths.
        if (least > -1e-3 && (least < 1e-3 || std::abs(area) < 0.05 * longest)) return {};
        if (least < 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const double w = weight[k] / facet[k].at.z;
            sum += w;
            time += w * facet[k].time;
            depth += w * facet[k].at.w;
        }
        found.emplace_back(time / sum, depth / sum);
    }
    std::sort(found.begin(), found.end(), [](auto& a, auto& b) { return a.x < b.x; });
    return found;
}

// ---- fragments

TEST_CASE("the light's ray meets a prism an even number of times") {
    for (const bool is_parallel : {true, false}) {
        INFO(is_parallel);
        CELLIST_RANDOM(random, is_parallel ? 71 : 72);
        const std::vector<Prism> prisms = random_prisms(random, 100'000, is_parallel);
        const Swept swept(prisms, is_parallel);
        std::size_t odd = 0, four = 0, outside = 0;
        for_each_prism(swept.fragments.download(), [&](std::size_t, cl_uint i, auto fragments) {
            odd += fragments.size() % 2;
            four += fragments.size() >= 4 ? 1U : 0U;
            float nearest = 100, farthest = 0;
            for (const MovingVertex& v : prisms[i]) {
                nearest = std::min({nearest, v.begin.s[3], v.end.s[3]});
                farthest = std::max({farthest, v.begin.s[3], v.end.s[3]});
            }
            for (const PrismFragment& f : fragments)
                if (!(f.time >= 0 && f.time <= 1 && f.depth >= nearest && f.depth <= farthest))
                    ++outside;
        });
        CHECK(swept.fragments_report.stored > 2'000'000);
        CHECK(odd == 0);
        CHECK(outside == 0);
        CHECK(four > 10'000);
        CHECK(swept.ranges_report.stored == swept.fragments_report.stored / 2);
        CHECK(swept.ranges_report.rejected == 0);
    }
}

TEST_CASE("prisms through the light's plane have an even number of fragments, too") {
    CELLIST_RANDOM(random, 73);
    std::vector<Prism> prisms = random_prisms(random, 400, false);
    for (Prism& prism : prisms)
        for (MovingVertex& v : prism)
            for (cl_float4* end : {&v.begin, &v.end})
                if (below(random, 3) == 0) {
                    const double w = uniform(random, -2, 0.5);
                    *end = vertex({end->s[0], end->s[1]}, w, w);
                }
    const Swept swept(prisms, false);
    std::size_t odd = 0, nearer = 0;
    for_each_prism(swept.fragments.download(), [&](std::size_t, cl_uint, auto fragments) {
        odd += fragments.size() % 2;
        for (const PrismFragment& f : fragments) nearer += f.depth < 0.25F ? 1U : 0U;
    });
    CHECK(odd == 0);
    CHECK(nearer > 1000);
}

TEST_CASE("fragments are where the paper's facets are, also where edges cross") {
    for (const bool is_parallel : {true, false}) {
        INFO(is_parallel);
        CELLIST_RANDOM(random, is_parallel ? 74 : 75);
        const std::vector<Prism> prisms = random_prisms(random, 2400, is_parallel);
        const Swept swept(prisms, is_parallel);
        std::map<std::pair<std::size_t, std::size_t>, std::vector<glm::dvec2>> found;
        for_each_prism(swept.fragments.download(),
                       [&](std::size_t texel, cl_uint triangle, auto fragments) {
                           for (const PrismFragment& f : fragments)
                               found[{triangle, texel}].emplace_back(f.time, f.depth);
                       });
        std::size_t compared = 0, other_count = 0, crossed = 0;
        double farthest_time = 0, farthest_depth = 0;
        for (std::size_t i = 0; i < prisms.size(); ++i) {
            const auto facets = facets_of(prisms[i]);
            if (!facets) continue;
            crossed += facets->size() < 14 ? 1U : 0U;
            glm::dvec2 low(1e9), high(-1e9);
            for (const auto& facet : *facets)
                for (const Corner& corner : facet) {
                    low = glm::min(low, glm::dvec2(corner.at) / corner.at.z);
                    high = glm::max(high, glm::dvec2(corner.at) / corner.at.z);
                }
            for (const std::size_t texel : texels_between(low, high)) {
                const auto expected = times_and_depths(*facets, texel_centre(texel));
                if (!expected) continue;
                auto& actual = found[{i, texel}];
                if (actual.size() != expected->size()) {
                    ++other_count;
                    continue;
                }
                std::sort(actual.begin(), actual.end(), [](auto& a, auto& b) { return a.x < b.x; });
                for (std::size_t k = 0; k < actual.size(); ++k) {
                    ++compared;
                    const glm::dvec2 apart = glm::abs(actual[k] - (*expected)[k]);
                    farthest_time = std::max(farthest_time, apart.x);
                    // The order of equal times is not defined.
                    if (k > 0 && actual[k].x - actual[k - 1].x < 1e-3) continue;
                    if (k + 1 < actual.size() && actual[k + 1].x - actual[k].x < 1e-3) continue;
                    farthest_depth = std::max(farthest_depth, apart.y);
                }
            }
        }
        CHECK(compared > 50'000);
        CHECK(crossed > 300);
        CHECK(other_count == 0);
        CHECK(farthest_time < 1e-3);
        CHECK(farthest_depth < 1e-3);
    }
}

TEST_CASE("a triangle that stays covers its texels for all of the exposure") {
    for (const bool is_parallel : {true, false}) {
        CELLIST_RANDOM(random, 76);
        const Swept swept(prisms_of(random, Kind::still, 1000, is_parallel), is_parallel);
        std::size_t groups = 0, other = 0;
        for_each_prism(swept.fragments.download(), [&](std::size_t, cl_uint, auto f) {
            ++groups;
            if (f.size() != 2 || f[0].depth != f[1].depth || f[0].time + f[1].time != 1) ++other;
        });
        for_each_prism(swept.ranges.download(), [&](std::size_t, cl_uint, auto r) {
            if (r.size() != 1 || r[0].begin != 0 || r[0].end != 1) ++other;
            if (r[0].depth_begin != r[0].depth_end) ++other;
        });
        CHECK(groups > 4000);
        CHECK(other == 0);
    }
}

TEST_CASE("triangles on both sides of a moving edge leave no gap and do not overlap") {
    CELLIST_RANDOM(random, 77);
    std::size_t compared = 0, apart = 0;
    for (int round = 0; round < 20; ++round) {
        // The edge from (0, -8) to (0, 8) moves 6 texels to the right, and turns.
        const double turn = uniform(random, -3, 3);
        const auto moving = [&](double x, double y) {
            const double off = uniform(random, 0, 1), depth = uniform(random, 2, 3);
            return MovingVertex{vertex({x + off, y}, depth, depth),
                                vertex({x + off + 6 + (y < 0 ? turn : -turn), y}, depth, depth)};
        };
        const MovingVertex low = moving(0, -8), high = moving(0, 8);
        std::vector<Prism> prisms{{low, high, moving(-20, 0)}, {low, high, moving(20, 0)}};
        for (Prism& prism : prisms) shuffle(prism, random);
        const Swept swept(prisms, false);
        const auto ranges = swept.ranges.download();
        for (std::size_t texel = 0; texel < texel_count; ++texel) {
            const glm::dvec2 place = texel_centre(texel);
            if (std::abs(place.y) > 2 || place.x < 2.5 || place.x > 4.5) continue;
            const auto list = ranges.cell(texel);
            REQUIRE(list.size() == 2);
            const auto& [before, after] =
                std::minmax(list[0], list[1], [](auto& a, auto& b) { return a.begin < b.begin; });
            ++compared;
            if (before.begin != 0 || before.end != after.begin || after.end != 1) ++apart;
        }
    }
    CHECK(compared == 240);
    CHECK(apart == 0);
}

// ---- ranges

HostLists<motion::VisibleRange> exact_ranges(Swept& swept) {
    Lists<motion::VisibleRange> ranges(device(), {texel_count});
    motion::Sweep sweep(device(), motion::kernels::sweep_exact_cl, ranges);
    ranges.build([&] { sweep.run(swept.scene, swept.light, ranges, swept.farthest); });
    return ranges.download();
}

// The depth of the moving plane. Empty where the light nearly sees it from its edge.
std::optional<double> plane_depth(const Prism& prism, const glm::dvec2& place, double time) {
    glm::dvec4 v[3];
    for (std::size_t k = 0; k < 3; ++k)
        v[k] = glm::mix(double4(prism[k].begin), double4(prism[k].end), time);
    double sum = 0, depth = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec4 &a = v[(k + 1) % 3], &b = v[(k + 2) % 3];
        const double weight = cross(glm::dvec2(a) - place * a.z, glm::dvec2(b) - place * b.z);
        sum += weight;
        depth += weight * v[k].w;
    }
    return std::abs(sum) < 1 ? std::optional<double>() : depth / sum;
}

TEST_CASE("translations have the same ranges as in the exact method") {
    for (const bool is_parallel : {true, false}) {
        INFO(is_parallel);
        CELLIST_RANDOM(random, is_parallel ? 78 : 79);
        const std::vector<Prism> prisms = prisms_of(random, Kind::translation, 4000, is_parallel);
        Swept swept(prisms, is_parallel);
        std::map<std::pair<std::size_t, std::size_t>, glm::dvec2> exact;
        std::size_t several = 0, compared = 0;
        for_each_prism(exact_ranges(swept), [&](std::size_t texel, cl_uint i, auto r) {
            several += r.size() != 1 ? 1U : 0U;
            exact[{i, texel}] = {r[0].begin, r[0].end};
        });
        double most_time = 0, most_depth = 0;
        for_each_prism(swept.ranges.download(), [&](std::size_t texel, cl_uint i, auto r) {
            several += r.size() != 1 ? 1U : 0U;
            ++compared;
            const glm::dvec2 times(r[0].begin, r[0].end), depths(r[0].depth_begin, r[0].depth_end);
            const glm::dvec2 expected = std::exchange(exact[{i, texel}], glm::dvec2(0));
            const glm::dvec2 apart = glm::abs(times - expected);
            most_time = std::max({most_time, apart.x, apart.y});
            for (const double time : {expected.x, expected.y}) {
                const auto depth = plane_depth(prisms[i], texel_centre(texel), time);
                if (!depth) continue;
                const double part = (time - times.x) / (times.y - times.x);
                most_depth =
                    std::max(most_depth, std::abs(glm::mix(depths.x, depths.y, part) - *depth));
            }
        });
        // Ranges that only the exact method has.
        for (const auto& [place, times] : exact) most_time = std::max(most_time, times.y - times.x);
        CHECK(compared > 50'000);
        CHECK(several == 0);
        CHECK(most_time < 1e-4);
        CHECK(most_depth < 1e-3);
    }
}

TEST_CASE("triangles that turn a little cover their texels for nearly the right time") {
    for (const bool is_parallel : {true, false}) {
        INFO(is_parallel);
        CELLIST_RANDOM(random, 80);
        Swept swept(prisms_of(random, Kind::small_turn, 4000, is_parallel), is_parallel);
        std::map<std::pair<std::size_t, std::size_t>, double> missing;
        for_each_prism(exact_ranges(swept), [&](std::size_t texel, cl_uint i, auto ranges) {
            for (const auto& r : ranges) missing[{i, texel}] += double(r.end - r.begin);
        });
        for_each_prism(swept.ranges.download(), [&](std::size_t texel, cl_uint i, auto ranges) {
            for (const auto& r : ranges) missing[{i, texel}] -= double(r.end - r.begin);
        });
        double sum = 0;
        for (const auto& [place, time] : missing) sum += std::abs(time);
        CHECK(missing.size() > 15'000);
        CHECK(sum / double(missing.size()) < 0.01);
        // The sides are not the bilinear surfaces.
        CHECK(sum / double(missing.size()) > 1e-4);
    }
}

// Inserts given fragments, and pairs them.
std::pair<HostLists<DepthTimeRange>, BuildReport> paired(
    const std::vector<std::vector<PrismFragment>>& texels) {
    std::vector<PrismFragment> all;
    std::vector<cl_uint> texel_of;
    for (std::size_t texel = 0; texel < texels.size(); ++texel)
        for (const PrismFragment& f : texels[texel]) {
            all.push_back(f);
            texel_of.push_back(cl_uint(texel));
        }
    const Buffer<PrismFragment> from(device(), all);
    const Buffer<cl_uint> to(device(), texel_of);
    Lists<PrismFragment> fragments(device(), {texels.size()});
    Lists<DepthTimeRange> ranges(device(), {texels.size()});
    Kernel put(device(),
               Source{.text = "#include <cellist/lists.clh>\n"
                              "kernel void put(CELLIST_LISTS(PrismFragment, lists), global const "
                              "PrismFragment* from, global const uint* to) {\n"
                              "    const uint i = get_global_id(0);\n"
                              "    cellist_insert(lists, to[i], from[i]);\n"
                              "}\n",
                      .file_name = "put"},
               "put", fragments);
    fragments.build(put, Range{all.size()}, from, to);
    const BuildReport report = make_ranges(ranges, fragments);
    return {ranges.download(), report};
}

TEST_CASE("fragments of the same triangle make ranges in pairs, in order of depth") {
    using Ranges = std::vector<std::array<float, 4>>;
    const std::vector<std::vector<PrismFragment>> texels{
        {{3, 0.25F, 7}, {1, 1, 7}, {4, 0.75F, 7}, {2, 0.5F, 7}},
        {{5, 1, 2}, {6, 0.5F, 1}, {7, 0, 1}, {4, 0, 2}},
        {},
        {{2, 1, 0}, {2, 0, 0}, {2, 0.75F, 0}, {2, 0.5F, 0}, {3, 1, 0}, {4, 1, 0}},
        {{1, 0, 9}, {2, 0.5F, 9}, {3, 1, 9}, {1, 0.5F, 10}, {1, 1, 11}, {1, 0, 11}}};
    const std::vector<Ranges> expected{{{0.25F, 0.75F, 3, 4}, {0.5F, 1, 2, 1}},
                                       {{0, 0.5F, 7, 6}, {0, 1, 4, 5}},
                                       {},
                                       {{0, 0.5F, 2, 2}, {0.75F, 1, 2, 2}, {1, 1, 3, 4}},
                                       {{0, 0.5F, 1, 2}, {0, 1, 1, 1}}};
    const auto [lists, report] = paired(texels);
    CHECK(report.stored == 9);
    // The third of triangle 9, and that of triangle 10.
    CHECK(report.rejected == 2);
    for (std::size_t texel = 0; texel < texels.size(); ++texel) {
        INFO(texel);
        Ranges ranges;
        for (const DepthTimeRange& r : lists.cell(texel))
            ranges.push_back({r.begin, r.end, r.depth_begin, r.depth_end});
        std::sort(ranges.begin(), ranges.end());
        Ranges sorted = expected[texel];
        std::sort(sorted.begin(), sorted.end());
        CHECK(ranges == sorted);
    }
}

// ---- pictures

double mean_difference(const std::vector<cl_float4>& a, const std::vector<cl_float4>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i].s[3] - b[i].s[3]));
    return sum / double(a.size());
}

TEST_CASE("pictures of what moves without turning are those of the exact method") {
    motion::Settings settings;
    settings.width = 160;
    settings.height = 120;
    settings.shadow_map = 256;
    settings.samples = 4;
    settings.compress = false;
    motion::Scene cubes = motion::make_cubes();
    motion::Scene still = cubes;
    still.end = still.begin;
    for (const motion::Scene& scene : {cubes, still}) {
        motion::Renderer renderer(device(), scene, settings);
        const auto draw = [&](motion::ShadowMethod& method) {
            renderer.draw(method);
            return renderer.picture().download();
        };
        const auto ranges = motion::make_ranges(renderer.frame());
        const auto exact = motion::make_exact(renderer.frame());
        const auto picture = draw(*ranges);
        CHECK(mean_difference(picture, draw(*exact)) < 1e-4);
        double dark = 0;
        for (const cl_float4& pixel : picture) dark += double(pixel.s[3]);
        CHECK(dark > 100);
        const motion::ShadowMapSize size = ranges->size();
        CHECK(size.fragments == 2 * size.ranges);
        CHECK(size.unpaired == 0);
        CHECK(size.refused == 0);
        CHECK(size.bytes >= 16 * size.fragments + 24 * size.ranges);
    }
}

TEST_CASE("triangles that are not finite are refused and counted") {
    motion::Scene scene = motion::make_cubes();
    scene.end[scene.triangles.back().x].y = std::numeric_limits<float>::quiet_NaN();
    std::size_t refused = 0;
    for (const glm::uvec3& t : scene.triangles) {
        const std::uint32_t bad = scene.triangles.back().x;
        refused += t.x == bad || t.y == bad || t.z == bad ? 1U : 0U;
    }
    motion::Settings settings;
    settings.width = settings.height = 32;
    settings.shadow_map = 64;
    settings.samples = 1;
    motion::Renderer renderer(device(), scene, settings);
    const auto ranges = motion::make_ranges(renderer.frame());
    renderer.draw(*ranges);
    CHECK(ranges->size().refused == refused);
    CHECK(ranges->size().ranges > 0);
    CHECK(ranges->size().unpaired == 0);
}

}  // namespace
}  // namespace cellist::test
