// SPDX-License-Identifier: MIT
// The scenes hold closed bodies that move over ground that stays, in the field of their light.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "input_error.hpp"
#include "scene.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

using motion::Scene;
using Vertices = std::vector<std::uint32_t>;

// A tetrahedron that stands on its side of 4 by 3, in triangles that face outwards.
support::Mesh tetrahedron() {
    support::Mesh mesh;
    mesh.positions = {{1, 5, 1}, {5, 5, 1}, {1, 5, 4}, {1, 7, 1}};
    mesh.normals.assign(4, glm::vec3(0, 1, 0));
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return mesh;
}

const std::vector<Scene>& all_scenes() {
    static const std::vector<Scene> scenes{
        motion::make_cubes(),
        motion::make_walker(),
        motion::make_walker(20'000),
        motion::make_fan(),
        motion::make_blinds(),
        motion::make_mesh_scene(tetrahedron(), {.move = {0.4, 0.3, -2}, .spin_degrees = 70})};
    return scenes;
}

// The triangles of each connected part.
std::vector<std::vector<glm::uvec3>> parts_of(const Scene& scene) {
    Vertices parent(scene.begin.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t vertex) {
        while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
        return vertex;
    };
    for (const glm::uvec3& t : scene.triangles) {
        parent[root(t.y)] = root(t.x);
        parent[root(t.z)] = root(t.x);
    }
    std::map<std::uint32_t, std::vector<glm::uvec3>> parts;
    for (const glm::uvec3& t : scene.triangles) parts[root(t.x)].push_back(t);
    std::vector<std::vector<glm::uvec3>> list;
    for (auto& [vertex, triangles] : parts) list.push_back(std::move(triangles));
    return list;
}

bool is_closed(const std::vector<glm::uvec3>& triangles) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const glm::uvec3& t : triangles)
        for (int k = 0; k < 3; ++k)
            if (!edges.emplace(t[k], t[(k + 1) % 3]).second) return false;
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return edges.contains({edge.second, edge.first});
    });
}

double volume(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions) {
    double sum = 0;
    for (const glm::uvec3& t : triangles)
        sum += glm::dot(glm::dvec3(positions[t.x]),
                        glm::cross(glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z]))) /
               6;
    return sum;
}

bool is_flat(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions) {
    glm::vec3 low(1e9F), high(-1e9F);
    for (const glm::uvec3& t : triangles)
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, positions[t[k]]);
            high = glm::max(high, positions[t[k]]);
        }
    const glm::vec3 size = high - low;
    return std::min({size.x, size.y, size.z}) < 1e-6F;
}

std::pair<glm::vec3, glm::vec3> bounds_of(const std::vector<glm::vec3>& positions,
                                          const std::function<bool(std::size_t)>& counts) {
    glm::vec3 low(1e9F), high(-1e9F);
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (counts(i)) {
            low = glm::min(low, positions[i]);
            high = glm::max(high, positions[i]);
        }
    return {low, high};
}

bool moves(const Scene& scene, std::size_t vertex) {
    return scene.begin[vertex] != scene.end[vertex];
}

TEST_CASE("scenes have indices, colours and coordinates that can be drawn") {
    std::set<std::string> names;
    for (const Scene& scene : all_scenes()) {
        INFO(scene.name);
        CHECK_FALSE(scene.name.empty());
        names.insert(scene.name);
        REQUIRE(scene.begin.size() == scene.end.size());
        REQUIRE(scene.colours.size() == scene.triangles.size());
        std::vector<bool> is_used(scene.begin.size());
        bool in_range = true, finite = true, opaque = true, above_ground = true;
        for (const glm::uvec3& t : scene.triangles)
            for (int k = 0; k < 3; ++k) {
                in_range = in_range && t[k] < is_used.size() && t[k] != t[(k + 1) % 3];
                if (t[k] < is_used.size()) is_used[t[k]] = true;
            }
        for (const auto* positions : {&scene.begin, &scene.end})
            for (const glm::vec3& p : *positions) {
                finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
                above_ground = above_ground && p.y >= -1e-4F;
            }
        for (const glm::u8vec4& colour : scene.colours) opaque = opaque && colour.a == 255;
        CHECK(in_range);
        CHECK(finite);
        CHECK(above_ground);
        CHECK(opaque);
        CHECK(std::find(is_used.begin(), is_used.end(), false) == is_used.end());
        CHECK(scene.field_degrees > 0);
        CHECK(scene.eye.y > 0);
    }
    CHECK(names == std::set<std::string>{"blinds", "cubes", "fan", "mesh", "walker"});
}

TEST_CASE("scenes have the numbers of triangles that the paper gives") {
    CHECK(motion::make_cubes().triangles.size() == 12'000);
    for (const std::size_t triangles : {12'000UL, 33'333UL, 265'000UL}) {
        const auto made = static_cast<double>(motion::make_walker(triangles).triangles.size());
        CHECK(made == Approx(static_cast<double>(triangles)).epsilon(0.01));
    }
    CHECK_THROWS_AS(motion::make_walker(11'999), support::InputError);
    CHECK_THROWS_AS(motion::make_walker(1'000'001), support::InputError);
}

TEST_CASE("bodies are closed and face outwards, and sheets stay where they are") {
    const std::map<std::string, std::pair<int, int>> expected{{"cubes", {1, 2}},
                                                              {"walker", {1, 1}},
                                                              {"fan", {1, 6}},
                                                              {"blinds", {2, 11}},
                                                              {"mesh", {1, 1}}};
    for (const Scene& scene : all_scenes()) {
        INFO(scene.name << " of " << scene.triangles.size());
        int sheets = 0, bodies = 0;
        for (const auto& part : parts_of(scene)) {
            if (is_flat(part, scene.begin)) {
                ++sheets;
                CHECK(std::none_of(part.begin(), part.end(), [&](const glm::uvec3& t) {
                    return moves(scene, t.x) || moves(scene, t.y) || moves(scene, t.z);
                }));
            } else {
                ++bodies;
                CHECK(is_closed(part));
                CHECK(volume(part, scene.begin) > 0);
                CHECK(volume(part, scene.end) > 0);
            }
        }
        CHECK(std::pair(sheets, bodies) == expected.at(scene.name));
    }
}

TEST_CASE("the ground comes first and has no large triangle") {
    for (const Scene& scene : all_scenes()) {
        INFO(scene.name);
        double largest = 0;
        for (std::size_t i = 0; i < 2 * 32 * 32; ++i) {
            const glm::uvec3 t = scene.triangles[i];
            for (int k = 0; k < 3; ++k) {
                REQUIRE(scene.begin[t[k]].y == 0);
                REQUIRE_FALSE(moves(scene, t[k]));
                largest = std::max(
                    largest, double(glm::distance(scene.begin[t[k]], scene.begin[t[(k + 1) % 3]])));
            }
        }
        CHECK(largest < 0.5);
    }
}

TEST_CASE("the light's square holds all, and its cone holds all that moves") {
    for (const Scene& scene : all_scenes()) {
        INFO(scene.name);
        const support::Light& light = scene.light;
        REQUIRE(light.is_spot);
        CHECK(light.field_degrees < 75);
        const glm::dvec3 forward = glm::normalize(light.target - light.position);
        REQUIRE(std::abs(forward.y) < 0.999);
        const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
        const glm::dvec3 down = glm::cross(forward, right);
        const double half = std::tan(0.5 * light.field_degrees * std::numbers::pi / 180);
        double nearest = std::numeric_limits<double>::max(), widest = 0, widest_moving = 0;
        for (std::size_t i = 0; i < scene.begin.size(); ++i)
            for (const glm::vec3& p : {scene.begin[i], scene.end[i]}) {
                const glm::dvec3 ray = glm::dvec3(p) - light.position;
                const double depth = glm::dot(ray, forward);
                const glm::dvec2 on_map(glm::dot(ray, right) / depth, glm::dot(ray, down) / depth);
                nearest = std::min(nearest, depth);
                widest = std::max({widest, std::abs(on_map.x), std::abs(on_map.y)});
                if (moves(scene, i)) widest_moving = std::max(widest_moving, glm::length(on_map));
            }
        CHECK(nearest > 0.5);
        CHECK(widest < half);
        CHECK(widest_moving < half);
        // The map is not larger than it has to be.
        CHECK(std::max(widest, widest_moving) > 0.85 * half);
    }
}

TEST_CASE("cubes move towards the light") {
    const Scene scene = motion::make_cubes();
    for (std::size_t i = 0; i < scene.begin.size(); ++i) {
        if (!moves(scene, i)) continue;
        REQUIRE(scene.end[i].y > scene.begin[i].y);
        REQUIRE(glm::distance(glm::dvec3(scene.end[i]), scene.light.position) <
                glm::distance(glm::dvec3(scene.begin[i]), scene.light.position));
    }
}

TEST_CASE("the walker swings one foot towards the light and stands on the other") {
    const Scene scene = motion::make_walker();
    double farthest = 0;
    std::size_t standing = 0, still_and_high = 0;
    for (std::size_t i = 33 * 33; i < scene.begin.size(); ++i) {
        const glm::dvec3 begin(scene.begin[i]), end(scene.end[i]);
        if (!moves(scene, i)) {
            ++standing;
            if (begin.y > 0.1) ++still_and_high;
        } else if (std::max(begin.y, end.y) < 0.4) {
            farthest = std::max(farthest, glm::distance(begin, scene.light.position) -
                                              glm::distance(end, scene.light.position));
        }
    }
    // The sole, at least.
    CHECK(standing > 1000);
    CHECK(still_and_high == 0);
    CHECK(farthest > 0.35);
    const auto [low, high] = bounds_of(scene.begin, [](std::size_t i) { return i >= 33 * 33; });
    CHECK(high.y == Approx(1.78).margin(0.04));
    CHECK(low.y == Approx(0).margin(0.01));
}

TEST_CASE("a mesh stands on the ground with its largest side of 1 m, and moves as told") {
    const auto is_mesh = [](std::size_t i) { return i >= 33 * 33; };
    const auto check = [](const glm::vec3& a, const glm::vec3& b) {
        CHECK(glm::distance(a, b) < 1e-5F);
    };
    {
        const Scene scene = motion::make_mesh_scene(tetrahedron(), {.move = {0.2, 0.1, -0.3}});
        const auto [low, high] = bounds_of(scene.begin, is_mesh);
        check(low, {-0.5, 0, -0.375});
        check(high, {0.5, 0.5, 0.375});
        for (std::size_t i = 33 * 33; i < scene.begin.size(); ++i)
            check(scene.end[i] - scene.begin[i], {0.2, 0.1, -0.3});
    }
    {
        // Does not move below the ground, and turns about the vertical: x goes to -z.
        const Scene scene =
            motion::make_mesh_scene(tetrahedron(), {.move = {0, -0.25, 0}, .spin_degrees = 90});
        CHECK(bounds_of(scene.begin, is_mesh).first.y == Approx(0.25));
        CHECK(bounds_of(scene.end, is_mesh).first.y == Approx(0).margin(1e-6));
        for (std::size_t i = 33 * 33; i < scene.begin.size(); ++i) {
            const glm::vec3 p = scene.begin[i];
            check(scene.end[i], {p.z, p.y - 0.25F, -p.x});
        }
    }
    // A mesh that stays is a scene, too.
    const Scene still = motion::make_mesh_scene(tetrahedron(), {});
    CHECK(still.begin == still.end);
}

TEST_CASE("a mesh keeps the colours of its file") {
    support::Mesh mesh = tetrahedron();
    mesh.materials.resize(2);
    mesh.materials[0].base_colour = glm::vec3(1, 0, 0);
    mesh.triangle_materials = {0, 1, 0, 0};
    const Scene scene = motion::make_mesh_scene(mesh, {});
    const std::size_t first = scene.triangles.size() - 4;
    const glm::u8vec4 red(255, 0, 0, 255);
    CHECK(scene.colours[first] == red);
    CHECK(scene.colours[first + 1] == motion::make_mesh_scene(tetrahedron(), {}).colours.back());
    mesh.colours.assign(4, glm::vec4(0.5F));
    CHECK(motion::make_mesh_scene(mesh, {}).colours[first] == glm::u8vec4(188, 0, 0, 255));
}

TEST_CASE("meshes and motions that cannot be drawn are errors of one line") {
    const auto message = [](const support::Mesh& mesh, const motion::RigidMotion& motion) {
        try {
            (void)motion::make_mesh_scene(mesh, motion);
        } catch (const support::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    support::Mesh point = tetrahedron(), endless = point, undefined = point;
    point.positions.assign(4, glm::vec3(1));
    endless.positions[1].x = std::numeric_limits<float>::infinity();
    undefined.positions[1].x = std::numeric_limits<float>::quiet_NaN();
    for (const std::string& text :
         {message({}, {}), message(point, {}), message(endless, {}), message(undefined, {}),
          message(tetrahedron(), {.move = {0, 11, 0}}),
          message(tetrahedron(), {.move = {std::nan(""), 0, 0}}),
          message(tetrahedron(), {.spin_degrees = infinity}),
          message(tetrahedron(), {.spin_degrees = -361})}) {
        CHECK_FALSE(text.empty());
        CHECK(text.find('\n') == std::string::npos);
    }
}

}  // namespace
}  // namespace cellist::test
