// SPDX-License-Identifier: MIT
// A still life of every way to blend: bottles whose content absorbs, filters that multiply, flames
// that add and glass that covers, on a tray and before rods that are opaque.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/ext/matrix_transform.hpp>

#include "scene/scenes.hpp"
#include "scene/shapes.hpp"

namespace oit {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double tray_height = -0.42;
constexpr double gap = 0.004;  ///< between the tray and what stands on it
constexpr int segments_around = 96;

using Tint = std::array<float, 3>;

Material material(const Tint& tint, Blend blend, float alpha, float gloss) {
    Material result = glass(alpha);
    for (std::size_t i = 0; i < 3; ++i) result.front_tint[i] = result.back_tint[i] = tint[i];
    result.blend = static_cast<cl_uint>(blend);
    result.gloss = gloss;
    return result;
}

/// The outline of a bottle that stands on z = 0, from the axis up to the axis again.
std::vector<dvec2> bottle_profile(double radius, double shoulder, double neck_radius,
                                  double height) {
    constexpr double rounding = 0.03;
    constexpr int parts = 8;
    std::vector<dvec2> profile{{0, 0}};
    const auto add = [&](const dvec2& centre, double r, double begin, double end) {
        const auto points = arc(centre, r, full_turn / 4 * begin, full_turn / 4 * end, parts);
        profile.insert(profile.end(), points.begin(), points.end());
    };
    add({radius - rounding, rounding}, rounding, -1, 0);
    add({neck_radius, shoulder}, radius - neck_radius, 0, 0.9);
    add({neck_radius - rounding / 2, height - rounding / 2}, rounding / 2, 0, 1);
    profile.emplace_back(0, height);
    return divided(profile, 0.05);
}

// Builds the scene part by part.
class BlendsBuilder {
public:
    explicit BlendsBuilder(float alpha) : alpha_(alpha) {}

    Scene build() {
        add_tray();
        add_bottle({-0.42, -0.02}, 0.20, {0.45F, 0.004F, 0.002F});
        add_bottle({0.02, -0.16}, 0.16, {0.01F, 0.25F, 0.03F});
        add_filters();
        for (const double x : {0.38, 0.62}) add_candle({x, 0.02});
        scene_.lighting = studio_lighting(static_cast<float>(tray_height) - 0.05F);
        // A bright background: filters and media only take light away.
        std::ranges::copy(Tint{0.42F, 0.47F, 0.55F}, scene_.lighting.background_top);
        std::ranges::copy(Tint{0.78F, 0.76F, 0.72F}, scene_.lighting.background_bottom);
        return std::move(scene_);
    }

private:
    void add(support::Mesh mesh, const Material& material, const glm::dmat4& place) {
        scene_.instances.push_back({.model = scene_.models.size(),
                                    .material = scene_.materials.size(),
                                    .to_world = place});
        scene_.models.push_back({.mesh = std::move(mesh)});
        scene_.materials.push_back(material);
    }

    /// Stands what was turned about the z axis upright, at (x, z) and so far above the tray.
    static glm::dmat4 standing(const dvec2& at, double above = gap) {
        return glm::rotate(glm::translate(glm::dmat4(1), dvec3(at.x, tray_height + above, at.y)),
                           -full_turn / 4, dvec3(1, 0, 0));
    }

    void add_tray() {
        const dvec2 profile[] = {{0, -0.05}, {0.86, -0.05}, {0.88, -0.03}, {0.88, 0}, {0, 0}};
        add(lathe(divided(profile, 0.1), segments_around, Corners::sharp),
            material({0.30F, 0.21F, 0.13F}, Blend::opaque, 1, 0.3F), standing({0, 0}, 0));
        const dvec2 rod[] = {{0, 0}, {0.035, 0}, {0.035, 0.95}, {0, 0.95}};
        for (int i = 0; i < 9; ++i) {
            const float shade = i % 2 == 0 ? 0.85F : 0.10F;
            add(lathe(divided(rod, 0.1), 32, Corners::sharp),
                material({shade, shade, shade}, Blend::opaque, 1, 0.4F),
                standing({0.15 * (i - 4), -0.45}));
        }
    }

    /// Glass around a medium; the tint is what passes a unit of length.
    void add_bottle(const dvec2& at, double radius, const Tint& tint) {
        constexpr double wall = 0.015;
        add(lathe(bottle_profile(radius, 0.42, 0.06, 0.80), segments_around, Corners::round),
            material({0.20F, 0.24F, 0.26F}, Blend::over, 0.3F * alpha_, 0.6F), standing(at));
        add(lathe(bottle_profile(radius - wall, 0.40, 0.06 - wall, 0.62), segments_around,
                  Corners::round),
            material(tint, Blend::absorb, 1, 0), standing(at, gap + wall));
    }

    /// Discs of the subtractive colours, which overlap.
    void add_filters() {
        const std::array<Tint, 3> tints{
            {{0.02F, 0.72F, 0.90F}, {0.90F, 0.05F, 0.60F}, {0.95F, 0.85F, 0.03F}}};
        for (std::size_t i = 0; i < tints.size(); ++i) {
            const double angle = full_turn * (0.25 + static_cast<double>(i) / 3);
            const dvec3 at(-0.05 + 0.12 * std::cos(angle), -0.14 + 0.12 * std::sin(angle),
                           0.40 + 0.04 * static_cast<double>(i));
            const dvec2 profile[] = {{0.18, 0}, {0, 0}};
            add(lathe(profile, segments_around, Corners::sharp),
                material(tints[i], Blend::multiplicative, 0.9F, 0),
                glm::translate(glm::dmat4(1), at));
        }
    }

    /// An opaque candle in a glass chimney. Its flame is four surfaces inside one another.
    void add_candle(const dvec2& at) {
        const dvec2 wax[] = {{0, 0}, {0.06, 0}, {0.06, 0.28}, {0.05, 0.29}, {0, 0.29}};
        add(lathe(divided(wax, 0.05), 48, Corners::sharp),
            material({0.80F, 0.76F, 0.66F}, Blend::opaque, 1, 0.2F), standing(at));
        for (const double size : {1.0, 0.75, 0.5, 0.25}) {
            std::vector<dvec2> flame;
            for (int i = 0; i <= 24; ++i) {
                const double up = i / 24.0;
                flame.emplace_back(0.055 * size * std::sin(full_turn / 2 * std::sqrt(up)),
                                   size * 0.20 * up);
            }
            flame.front().x = flame.back().x = 0;
            add(lathe(flame, 48, Corners::round),
                material({1.0F, 0.45F, 0.08F}, Blend::additive, 0.35F, 0), standing(at, 0.30));
        }
        add(sleeve(0.100, 0.106, 0, 0.62, segments_around, 0.05),
            material({0.16F, 0.20F, 0.24F}, Blend::over, 0.3F * alpha_, 0.6F), standing(at));
    }

    float alpha_;
    Scene scene_;
};

Scene make_blends(float alpha) { return BlendsBuilder(alpha).build(); }

const SceneRegistration blends_scene(
    {.name = "blends",
     .summary = "a still life of surfaces that cover, add, filter and absorb, before opaque ones",
     .make = make_blends});

}  // namespace
}  // namespace oit
