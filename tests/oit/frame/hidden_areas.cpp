// SPDX-License-Identifier: MIT
// With exact coverage, opaque surfaces hide exactly the areas that they cover.
#include <algorithm>
#include <cmath>

#include "camera.hpp"
#include "oit/support/flat_scene.hpp"
#include "oit/support/polygons.hpp"
#include "oit/support/random_scene.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

// A triangle at a depth, of a primary colour or of white, opaque or not.
struct Layer {
    std::array<Point, 3> corners;
    float depth;
    std::size_t colour;
};

// What is left of polygons without a triangle, and how much the triangle takes. No limits, and no
// code of the device.
double take(std::vector<Polygon>& polygons, const std::array<glm::dvec2, 3>& triangle) {
    std::vector<Polygon> left;
    double taken = 0;
    const glm::dvec2 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
    const double side = u.x * v.y - u.y * v.x > 0 ? 1 : -1;
    for (Polygon inner : polygons) {
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 p = triangle[i], d = (triangle[(i + 1) % 3] - p) * side;
            const double a = -d.y, b = d.x, c = d.y * p.x - d.x * p.y;
            left.push_back(cut(inner, -a, -b, -c));
            inner = cut(inner, a, b, c);
        }
        taken += std::abs(twice_area(inner)) / 2;
    }
    std::erase_if(left, [](const Polygon& polygon) {
        return polygon.size() < 3 || std::abs(twice_area(polygon)) < 1e-9;
    });
    polygons = std::move(left);
    return taken;
}

// The visible part of each colour in a pixel; the fourth is what nothing covers.
std::array<double, 4> visible_parts(const std::vector<Layer>& nearest_first, int x, int y,
                                    int side) {
    const glm::dvec2 corner(256 * x - 128 * side, 256 * y - 128 * side);
    std::vector<Polygon> polygons{{{0, 0}, {256, 0}, {256, 256}, {0, 256}}};
    std::array<double, 4> parts{0, 0, 0, 1};
    for (const Layer& layer : nearest_first) {
        std::array<glm::dvec2, 3> triangle{};
        for (std::size_t i = 0; i < 3; ++i)
            triangle[i] = glm::dvec2(layer.corners[i].x, layer.corners[i].y) - corner;
        const auto beyond = [&](double glm::dvec2::*axis) {
            const auto [least, most] =
                std::minmax({triangle[0].*axis, triangle[1].*axis, triangle[2].*axis});
            return most <= 0 || least >= 256;
        };
        if (polygons.empty() || beyond(&glm::dvec2::x) || beyond(&glm::dvec2::y)) continue;
        const double part = take(polygons, triangle) / 65536;
        parts[layer.colour] += part;
        parts[3] -= part;
    }
    return parts;
}

std::vector<Layer> random_layers(std::mt19937& random, std::size_t count, int reach) {
    std::vector<Layer> layers(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (Point& p : layers[i].corners)
            p = {static_cast<int>(below(random, static_cast<std::uint32_t>(2 * reach))) - reach,
                 static_cast<int>(below(random, static_cast<std::uint32_t>(2 * reach))) - reach};
        layers[i].depth = 1 + 0.01F * static_cast<float>(i);
        layers[i].colour = i % 3;
    }
    return layers;
}

oit::Scene scene_of_layers(const std::vector<Layer>& layers) {
    oit::Scene scene = flat_scene(0);
    for (std::size_t colour = 0; colour < 3; ++colour) {
        support::Mesh mesh;
        for (const Layer& layer : layers) {
            if (layer.colour != colour) continue;
            add_triangle(mesh, layer.corners[0], layer.corners[1], layer.corners[2]);
            for (auto p = mesh.positions.end() - 3; p != mesh.positions.end(); ++p)
                *p *= layer.depth;
        }
        std::array<float, 3> tint{0, 0, 0};
        tint[colour] = 1;
        if (!mesh.triangles.empty()) add_model(scene, mesh, oit::Blend::opaque, 1, tint, tint);
    }
    return scene;
}

constexpr int picture_side = 24;

// Of the largest channel of each pixel.
struct Errors {
    std::size_t off = 0;  // pixels, by more than 1e-5
    double largest = 0, mean = 0;
};

Errors errors_of_layers(const std::vector<Layer>& layers) {
    const oit::Scene scene = scene_of_layers(layers);
    const std::vector<cl_float4> picture =
        drawn({.scene = scene,
               .views = {shaded_pixel_view(picture_side, picture_side)},
               .quality = {.coverage = oit::Coverage::exact}});
    Errors errors;
    for (int y = 0; y < picture_side; ++y)
        for (int x = 0; x < picture_side; ++x) {
            const std::array<double, 4> parts = visible_parts(layers, x, y, picture_side);
            double error = 0;
            for (std::size_t c = 0; c < 3; ++c)
                error = std::max(
                    error,
                    std::abs(static_cast<double>(
                                 picture[static_cast<std::size_t>(y * picture_side + x)].s[c]) -
                             parts[c]));
            errors.off += error > 1e-5 ? 1U : 0U;
            errors.largest = std::max(errors.largest, error);
            errors.mean += error / (picture_side * picture_side);
        }
    return errors;
}

TEST_CASE("opaque triangles hide exactly what they cover of others") {
    CELLIST_RANDOM(random, 91u);
    for (const auto& [count, reach_pixels] :
         {std::pair{6, 12}, std::pair{40, 40}, std::pair{60, 300}, std::pair{400, 4000}})
        for (int round = 0; round < 3; ++round) {
            const auto [off, largest, mean] = errors_of_layers(
                random_layers(random, static_cast<std::size_t>(count), 256 * reach_pixels));
            INFO(count << " triangles of up to " << reach_pixels << " pixels: " << off
                       << " pixels off, by up to " << largest << ", in the mean by " << mean);
            CHECK(off == 0);
        }
}

TEST_CASE("where opaque triangles leave many pieces of a pixel, points decide") {
    CELLIST_RANDOM(random, 92u);
    // Thousands of triangles of less than a pixel, some 40 of which meet in each pixel.
    for (int round = 0; round < 2; ++round) {
        std::vector<Layer> layers = random_layers(random, 6000, 150);
        for (std::size_t i = 0; i < layers.size(); ++i)
            for (Point& p : layers[i].corners) {
                p.x += (static_cast<int>(i * 7919 % 24) - 12) * 256 + 128;
                p.y += (static_cast<int>(i * 104729 / 24 % 24) - 12) * 256 + 128;
            }
        const auto [off, largest, mean] = errors_of_layers(layers);
        INFO(off << " of " << picture_side * picture_side << " pixels off, by up to " << largest
                 << ", in the mean by " << mean);
        // The area below 32 random points has a deviation of up to 0.5 / sqrt(32) = 0.088, and a
        // mean error of 0.07. The points of a pixel are spread better than that.
        CHECK(largest < 0.3);
        CHECK(mean < 0.05);
    }
}

TEST_CASE("no light is lost or won among surfaces as bright as the background") {
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        INFO("seed " << seed);
        oit::Scene scene = random_scene(seed, {oit::Blend::over, oit::Blend::opaque}, 60);
        // Everything is white, and nothing is shaded.
        const oit::Scene white = flat_scene(1);
        scene.lighting = white.lighting;
        for (int c = 0; c < 3; ++c)
            scene.lighting.floor_light[c] = scene.lighting.floor_dark[c] = 1;
        scene.lighting.floor_shadow = 0;
        for (oit::Material& material : scene.materials) {
            material.gloss = 0;
            for (int c = 0; c < 3; ++c) material.front_tint[c] = material.back_tint[c] = 1;
        }
        double largest = 0;
        for (const cl_float4& pixel : drawn({.scene = scene,
                                      .views = {support::frame_unit_sphere({40, 15}, 100, 80)},
                                      .quality = {.coverage = oit::Coverage::exact}})) {
            const double error = std::abs(static_cast<double>(pixel.s[0]) - 1);
            largest = error <= largest ? largest : error;  // NaN as well
        }
        CHECK(largest <= 1e-4);
    }
}

}  // namespace
}  // namespace cellist::test
