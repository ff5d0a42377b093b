// SPDX-License-Identifier: MIT
// With exact coverage, a surface counts by the area of each pixel that it covers.
#include <cmath>

#include "camera.hpp"
#include "oit/support/flat_scene.hpp"
#include "oit/support/polygons.hpp"
#include "oit/support/procedural.hpp"
#include "reference/projection.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

constexpr oit::Quality by_area{.coverage = oit::Coverage::exact};

// White triangles that hide a black background to the part alpha, in a picture.
std::vector<cl_float4> picture_of(const support::Mesh& mesh, int width, int height,
                                  oit::Blend blend, float alpha = 1) {
    oit::Scene scene = flat_scene(0);
    add_model(scene, mesh, blend, alpha, {1, 1, 1}, {1, 1, 1});
    return drawn({.scene = scene, .views = {shaded_pixel_view(width, height)}, .quality = by_area});
}

struct Errors {
    double largest = 0;
    std::size_t edge_pixels = 0;
};

// Adds what a triangle covers of each pixel.
void add_parts(std::vector<double>& parts, Point a, Point b, Point c, int width, int height,
               std::size_t* edge_pixels = nullptr) {
    const auto first = [](int least, int side) {
        return std::clamp((least + 128 * side) / 256 - 1, 0, side);
    };
    const auto end = [](int most, int side) {
        return std::clamp((most + 128 * side) / 256 + 2, 0, side);
    };
    for (int y = first(std::min({a.y, b.y, c.y}), height);
         y < end(std::max({a.y, b.y, c.y}), height); ++y)
        for (int x = first(std::min({a.x, b.x, c.x}), width);
             x < end(std::max({a.x, b.x, c.x}), width); ++x) {
            const double part = covered_part(a, b, c, x, y, width, height);
            parts[static_cast<std::size_t>(y * width + x)] += part;
            if (edge_pixels != nullptr && part > 0 && part < 1) ++*edge_pixels;
        }
}

// Triangles of a picture, each alone in its pixels where `blend` is not additive.
Errors errors_of(const std::vector<std::array<Point, 3>>& triangles, int width, int height,
                 oit::Blend blend) {
    support::Mesh mesh;
    std::vector<double> expected(static_cast<std::size_t>(width * height), 0);
    Errors errors;
    for (const auto& [a, b, c] : triangles) {
        add_triangle(mesh, a, b, c);
        add_parts(expected, a, b, c, width, height, &errors.edge_pixels);
    }
    const std::vector<cl_float4> picture = picture_of(mesh, width, height, blend);
    for (std::size_t p = 0; p < picture.size(); ++p)
        errors.largest =
            std::max(errors.largest, std::abs(static_cast<double>(picture[p].s[0]) - expected[p]));
    return errors;
}

std::vector<std::array<Point, 3>> some_triangles(std::mt19937& random, std::size_t count, int reach,
                                                 int step = 1) {
    const auto coordinate = [&] {
        return static_cast<int>(below(random, static_cast<std::uint32_t>(2 * reach / step + 1))) *
                   step -
               reach;
    };
    std::vector<std::array<Point, 3>> triangles(count);
    for (auto& triangle : triangles)
        for (Point& p : triangle) p = {coordinate(), coordinate()};
    return triangles;
}

TEST_CASE("the area of an isolated edge pixel is exact") {
    CELLIST_RANDOM(random, 81u);
    // Tiles of 16 pixels, a triangle in each.
    constexpr int tiles = 24, tile = 16 * 256;
    std::size_t edge_pixels = 0;
    for (int round = 0; round < 5; ++round) {
        std::vector<std::array<Point, 3>> triangles =
            some_triangles(random, tiles * tiles, tile / 2);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            if (i % 5 == 1)  // a sliver
                triangles[i][2] = {
                    std::clamp(triangles[i][1].x + static_cast<int>(below(random, 3)) - 1,
                               -tile / 2, tile / 2),
                    triangles[i][1].y};
            for (Point& p : triangles[i]) {
                p.x += (2 * static_cast<int>(i % tiles) + 1 - tiles) * tile / 2;
                p.y += (2 * static_cast<int>(i / tiles) + 1 - tiles) * tile / 2;
            }
        }
        const Errors errors = errors_of(triangles, 16 * tiles, 16 * tiles, oit::Blend::over);
        INFO(errors.largest << " in " << errors.edge_pixels << " pixels");
        CHECK(errors.largest <= 1e-6);
        edge_pixels += errors.edge_pixels;
    }
    CHECK(edge_pixels > 50'000);
}

TEST_CASE("areas of triangles of any size add up exactly") {
    CELLIST_RANDOM(random, 82u);
    std::size_t edge_pixels = 0;
    // Up to the guard band. Steps of 256 put corners on corners of pixels.
    for (const int step : {1, 256})
        for (const int reach_pixels : {1, 8, 50, 400, 3000, 16000}) {
            INFO("reach " << reach_pixels << " pixels, in steps of " << step);
            const std::vector<std::array<Point, 3>> triangles =
                some_triangles(random, 150, 256 * reach_pixels, step);
            const Errors errors = errors_of(triangles, 96, 64, oit::Blend::additive);
            INFO("error " << errors.largest);
            CHECK(errors.largest <= 2e-5);  // a sum of up to 150
            edge_pixels += errors.edge_pixels;
        }
    CHECK(edge_pixels > 50'000);
}

TEST_CASE("slivers thinner than a sub-pixel and triangles inside of a pixel have their areas") {
    CELLIST_RANDOM(random, 83u);
    for (const int reach_pixels : {2, 40, 2000}) {
        std::vector<std::array<Point, 3>> slivers = some_triangles(random, 200, 256 * reach_pixels);
        for (auto& triangle : slivers)
            triangle[2] = {triangle[1].x + static_cast<int>(below(random, 3)) - 1,
                           triangle[1].y + static_cast<int>(below(random, 3)) - 1};
        INFO("reach " << reach_pixels);
        CHECK(errors_of(slivers, 64, 48, oit::Blend::additive).largest <= 2e-6);
    }
    CHECK(errors_of(some_triangles(random, 3000, 120), 3, 3, oit::Blend::additive).largest <= 1e-3);
    // Exactly one pixel, and exactly half of one.
    const std::array<Point, 3> upper{Point{0, 0}, Point{256, 0}, Point{0, 256}};
    const std::array<Point, 3> lower{Point{256, 0}, Point{256, 256}, Point{0, 256}};
    CHECK(errors_of({upper}, 4, 4, oit::Blend::over).largest == 0);
    CHECK(errors_of({upper, lower}, 4, 4, oit::Blend::over).largest <= 1e-7);
}

TEST_CASE("triangles that are clipped have the areas of their pieces") {
    CELLIST_RANDOM(random, 84u);
    constexpr int width = 80, height = 60;
    const raster::View view = shaded_pixel_view(width, height);
    const oit::Projection<float> projection(glm::dmat4(1), view);
    std::vector<double> expected(width * height, 0);
    support::Mesh mesh;
    const auto coordinate = [&](double reach) {
        return static_cast<float>((2.0 * below(random, 1u << 24) / (1 << 24) - 1) * reach);
    };
    for (int i = 0; i < 60; ++i) {
        std::array<glm::vec3, 3> corners{};
        // Beyond the guard band, or through the near plane.
        for (glm::vec3& p : corners)
            p = i % 2 == 0 ? glm::vec3(coordinate(40000), coordinate(40000), 1)
                           : glm::vec3(coordinate(40), coordinate(40), 0.8F + coordinate(1));
        const oit::Projection<float>::Polygon polygon = projection.clipped(corners);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec3& p : corners) {
            mesh.positions.push_back(p);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        const auto snapped = [&](std::size_t v) {
            const auto [x, y] = projection.position(polygon[v]);
            return Point{static_cast<int>(std::nearbyint(x)), static_cast<int>(std::nearbyint(y))};
        };
        for (std::size_t v = 2; v < polygon.size(); ++v)
            add_parts(expected, snapped(0), snapped(v - 1), snapped(v), width, height);
    }
    const std::vector<cl_float4> picture = picture_of(mesh, width, height, oit::Blend::additive);
    double largest = 0, sum = 0;
    for (std::size_t p = 0; p < picture.size(); ++p) {
        largest = std::max(largest, std::abs(static_cast<double>(picture[p].s[0]) - expected[p]));
        sum += expected[p];
    }
    CHECK(sum > 1000);
    CHECK(largest <= 1e-5);
}

TEST_CASE("triangles that share edges cover each pixel once, whatever their size") {
    CELLIST_RANDOM(random, 85u);
    for (const double cell_pixels : {0.05, 0.3, 1.0, 3.0, 20.0}) {
        INFO("cells of " << cell_pixels << " pixels");
        const int side = cell_pixels < 0.1 ? 5 : 32;
        const int cells = static_cast<int>(side / cell_pixels) + 3;
        const double cell = 256 * cell_pixels;
        std::vector<Point> points;
        for (int y = 0; y <= cells; ++y)
            for (int x = 0; x <= cells; ++x) {
                const auto near = [&](int i) {
                    return static_cast<int>(
                        std::lround((i - 0.5 * cells + 0.4 * below(random, 1000) / 1000) * cell));
                };
                points.push_back({near(x), near(y)});
            }
        support::Mesh mesh;
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x) {
                const auto at = [&](int i, int j) {
                    return points[static_cast<std::size_t>((y + j) * (cells + 1) + x + i)];
                };
                add_triangle(mesh, at(0, 0), at(1, 0), at(1, 1));
                add_triangle(mesh, at(1, 1), at(0, 0), at(0, 1));
            }
        for (const auto& [blend, alpha] :
             {std::pair{oit::Blend::additive, 1.0F}, std::pair{oit::Blend::over, 0.5F}}) {
            double largest = 0;
            for (const cl_float4& pixel : picture_of(mesh, side, side, blend, alpha))
                largest = std::max(largest, std::abs(static_cast<double>(pixel.s[0]) -
                                                     static_cast<double>(alpha)));
            INFO("alpha " << alpha);
            CHECK(largest <= 1e-5);
        }
    }
}

TEST_CASE("front and back of a closed mesh cover the same area of each pixel") {
    oit::Scene scene = flat_scene(0);
    add_model(scene, torus_knot(2, 3, 400, 24), oit::Blend::additive, 1, {1, 0, 0}, {0, 1, 0});
    double largest = 0, sum = 0;
    for (const cl_float4& pixel : drawn({.scene = scene,
                                  .views = {support::frame_unit_sphere({30, 10}, 120, 90)},
                                  .quality = by_area})) {
        largest = std::max(largest, std::abs(static_cast<double>(pixel.s[0] - pixel.s[1])));
        sum += static_cast<double>(pixel.s[0]);
    }
    CHECK(sum > 500);
    CHECK(largest <= 1e-5);
}

TEST_CASE("an edge before a whole layer is exact") {
    CELLIST_RANDOM(random, 86u);
    // Half-transparent triangles, alone in their tiles, before a layer that fills the picture.
    constexpr int tiles = 12, tile = 16 * 256, side = 16 * tiles;
    const auto at_depth = [](support::Mesh& mesh, float depth) {
        for (glm::vec3& p : mesh.positions) p *= depth;
    };
    support::Mesh front, behind;
    std::vector<double> part(side * side, 0);
    std::vector<std::array<Point, 3>> triangles = some_triangles(random, tiles * tiles, tile / 2);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (Point& p : triangles[i]) {
            p.x += (2 * static_cast<int>(i % tiles) + 1 - tiles) * tile / 2;
            p.y += (2 * static_cast<int>(i / tiles) + 1 - tiles) * tile / 2;
        }
        const auto& [a, b, c] = triangles[i];
        add_triangle(front, a, b, c);
        add_parts(part, a, b, c, side, side);
    }
    constexpr int all = 256 * side;
    add_triangle(behind, {-all, -all}, {3 * all, -all}, {-all, 3 * all});
    at_depth(behind, 2);
    oit::Scene scene = flat_scene(0);
    add_model(scene, front, oit::Blend::over, 0.5F, {1, 0, 0}, {1, 0, 0});
    add_model(scene, behind, oit::Blend::over, 0.75F, {0, 1, 0}, {0, 1, 0});
    const std::vector<cl_float4> picture =
        drawn({.scene = scene, .views = {shaded_pixel_view(side, side)}, .quality = by_area});
    double largest = 0;
    for (std::size_t p = 0; p < picture.size(); ++p) {
        largest = std::max(largest, std::abs(static_cast<double>(picture[p].s[0]) - 0.5 * part[p]));
        largest = std::max(
            largest, std::abs(static_cast<double>(picture[p].s[1]) - 0.75 * (1 - 0.5 * part[p])));
    }
    CHECK(largest <= 1e-3);
}

}  // namespace
}  // namespace cellist::test
