// SPDX-License-Identifier: MIT
// The neighbour search finds every neighbour, wherever the points are.
#include <cmath>
#include <limits>
#include <random>

#include <cellist/cellist.hpp>

#include "neighbour_search.hpp"
#include "reference.hpp"
#include "scene.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using particles::Box;
using particles::Scene;

Scene scene_of(Box box, float radius, std::vector<cl_float4> points) {
    Scene scene;
    scene.box = box;
    scene.radius = radius;
    scene.points = std::move(points);
    for (const cl_float4& point : scene.points)
        if (!particles::is_finite(point)) ++scene.invalid;
    return scene;
}

void require_all_found(const Scene& scene) {
    for (const Storage storage : all_storages)
        for (const int cells : {1, 2, 3}) {
            INFO("storage " << static_cast<int>(storage) << ", cells " << cells);
            particles::NeighbourSearch search(device(), scene, storage, cells);
            const BuildReport report = search.build();
            CHECK(report.rejected == scene.invalid);
            CHECK(report.stored == scene.points.size() - scene.invalid);
            CHECK(search.lists().validate().ok());
            search.find();
            CHECK(particles::compare(scene, search.found(), scene.points.size()).different == 0);
        }
}

std::vector<cl_float4> random_points(std::size_t count, float low, float high) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> coordinate(low, high);
    std::vector<cl_float4> points(count);
    for (cl_float4& point : points)
        point = {{coordinate(random), coordinate(random), coordinate(random), 0}};
    return points;
}

TEST_CASE("scenes of all sizes") {
    for (const std::size_t points : {0U, 1U, 2U, 7U, 16U, 93U, 4096U})
        for (const Box box : {Box::open, Box::periodic})
            require_all_found(particles::make_scene(points, 30, box, 1));
}

TEST_CASE("all points in one place, and at exactly the radius") {
    require_all_found(
        scene_of(Box::open, 0.25F, std::vector<cl_float4>(300, cl_float4{{1, 2, 3, 0}})));
    std::vector<cl_float4> lattice;
    for (int i = 0; i < 512; ++i)
        lattice.push_back(
            {{0.125F * static_cast<float>(i % 8), 0.125F * static_cast<float>(i / 8 % 8),
              0.125F * static_cast<float>(i / 64), 0}});
    for (const Box box : {Box::open, Box::periodic}) {
        require_all_found(scene_of(box, 0.125F, lattice));
        require_all_found(scene_of(box, 0.25F, lattice));
        require_all_found(scene_of(box, std::nextafter(0.125F, 0.0F), lattice));
    }
}

TEST_CASE("clusters that are far apart, and far from the origin") {
    std::vector<cl_float4> points = random_points(500, -0.5F, 0.5F);
    for (std::size_t i = 0; i < points.size(); ++i) {
        constexpr float places[] = {0, 1000, -54321, 1e6F, -3e9F, 1e20F, 3e38F};
        for (float& x : points[i].s) x += places[i % 7];
    }
    require_all_found(scene_of(Box::open, 0.1F, points));
    require_all_found(scene_of(Box::periodic, 0.1F, points));
}

TEST_CASE("neighbours on both sides of a periodic wall") {
    const float last = std::nextafter(1.0F, 0.0F);
    std::vector<cl_float4> points = random_points(200, 0, 1);
    for (std::size_t i = 0; i < points.size(); ++i) points[i].s[i % 3] = i % 2 == 0 ? 0.0F : last;
    points.push_back({{-1e-9F, 1, -1, 0}});
    points.push_back({{last, last, last, 0}});
    points.push_back({{0, 0, 0, 0}});
    for (const float radius : {0.05F, 0.2F, 0.34F, 0.5F})
        require_all_found(scene_of(Box::periodic, radius, points));
}

TEST_CASE("points without a place are rejected") {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<cl_float4> points = random_points(50, 0, 1);
    for (std::size_t i = 0; i < 30; ++i)
        points[i].s[i % 3] = i % 5 == 0 ? nan : i % 2 == 0 ? infinity : -infinity;
    for (const Box box : {Box::open, Box::periodic}) require_all_found(scene_of(box, 0.3F, points));
}

}  // namespace
}  // namespace cellist::test
