// SPDX-License-Identifier: MIT
// Surfaces of smoke: rings of particles that rise through an analytic flow leave surfaces behind
// them, the thinner the more the flow stretches them (von Funck, Weinkauf, Theisel, Seidel: "Smoke
// Surfaces", IEEE TVCG 2008, section 3).
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/scenes.hpp"
#include "scene/shapes.hpp"

namespace oit {
namespace {

using glm::dvec3;

constexpr int surfaces = 4;
constexpr int seeds = 240;  ///< particles of a ring
constexpr int steps = 280;  ///< of time, each leaving a row of vertices
constexpr double step = 0.011;
constexpr double fading = 0.25;  ///< part of the rows over which the oldest smoke dissolves

// A plume that swirls around the y axis, with eddies that grow with height. The eddies are the curl
// of a vector potential, so they compress nothing.
dvec3 velocity(const dvec3& p) {
    const double from_axis_squared = p.x * p.x + p.z * p.z;
    const double swirl = 1.7 * std::exp(-6 * from_axis_squared);
    dvec3 v(-swirl * p.z, 0.30 + 0.55 * std::exp(-7 * from_axis_squared), swirl * p.x);
    const double growth = std::clamp((p.y + 0.9) / 1.2, 0.0, 1.0);
    struct Eddy {
        dvec3 axis, wave;
        double strength, phase;
    };
    static const Eddy eddies[] = {{{0.8, 0.1, 0.6}, {2.1, 4.3, -1.7}, 0.68, 0.4},
                                  {{-0.5, 0.3, 0.8}, {-3.4, 5.2, 2.6}, 0.60, 2.1},
                                  {{0.2, 0.9, -0.4}, {6.1, 2.3, 5.4}, 0.48, 4.0},
                                  {{0.9, -0.4, -0.1}, {4.2, 8.5, -6.3}, 0.40, 1.3}};
    for (const Eddy& eddy : eddies)
        v += growth * eddy.strength * std::cos(glm::dot(eddy.wave, p) + eddy.phase) *
             glm::cross(glm::normalize(eddy.wave), eddy.axis);
    return v;
}

// Runge-Kutta of fourth order.
dvec3 moved(const dvec3& p) {
    const dvec3 a = velocity(p);
    const dvec3 b = velocity(p + 0.5 * step * a);
    const dvec3 c = velocity(p + 0.5 * step * b);
    const dvec3 d = velocity(p + step * c);
    return p + step / 6 * (a + 2.0 * b + 2.0 * c + d);
}

// Rows of particles, the youngest first.
class Trace {
public:
    explicit Trace(double radius) {
        for (int i = 0; i < seeds; ++i) {
            const double angle = full_turn * i / seeds;
            // A scalloped ring gives folds.
            const double r = radius * (1 + 0.15 * std::cos(5 * angle));
            points_.emplace_back(r * std::cos(angle), -0.95, r * std::sin(angle));
        }
        for (int row = 1; row <= steps; ++row)
            for (int i = 0; i < seeds; ++i) points_.push_back(moved(at(row - 1, i)));
    }

    [[nodiscard]] const dvec3& at(int row, int i) const {
        return points_[static_cast<std::size_t>(row * seeds + (i + seeds) % seeds)];
    }
    // The vector area between neighbours around a particle: its direction is the normal.
    [[nodiscard]] dvec3 area(int row, int i) const {
        const dvec3 across = at(row, i + 1) - at(row, i - 1);
        const dvec3 along = at(std::min(row + 1, steps), i) - at(std::max(row - 1, 0), i);
        const double rows = row == 0 || row == steps ? 1 : 2;
        return glm::cross(along, across) / (2 * rows);
    }

private:
    std::vector<dvec3> points_;
};

Model model_of(const Trace& trace) {
    Model model;
    for (int row = 0; row <= steps; ++row)
        for (int i = 0; i < seeds; ++i) {
            const dvec3 area = trace.area(row, i);
            const double size = std::max(glm::length(area), 1e-12);
            model.mesh.positions.emplace_back(trace.at(row, i));
            model.mesh.normals.emplace_back(area / size);
            // The same smoke on more area.
            const double stretch = size / glm::length(trace.area(0, i));
            const double age = static_cast<double>(row) / steps;
            model.opacities.push_back(static_cast<float>(std::min(1.0, 1 / stretch) *
                                                         std::clamp((1 - age) / fading, 0.0, 1.0)));
        }
    const auto at = [](int row, int i) {
        return static_cast<std::uint32_t>(row * seeds + i % seeds);
    };
    for (int row = 0; row < steps; ++row)
        for (int i = 0; i < seeds; ++i) {
            model.mesh.triangles.push_back({at(row, i), at(row + 1, i), at(row + 1, i + 1)});
            model.mesh.triangles.push_back({at(row, i), at(row + 1, i + 1), at(row, i + 1)});
        }
    return model;
}

// Centres the smoke in the unit sphere, above the floor.
void fit(Scene& scene) {
    dvec3 low(1e9), high(-1e9);
    for (const Model& model : scene.models)
        for (const glm::vec3& p : model.mesh.positions) {
            low = glm::min(low, dvec3(p));
            high = glm::max(high, dvec3(p));
        }
    const double scale = 2 / glm::length(high - low);
    for (Model& model : scene.models)
        for (glm::vec3& p : model.mesh.positions)
            p = glm::vec3(scale * (dvec3(p) - 0.5 * (low + high)));
    scene.lighting = studio_lighting(static_cast<float>(-0.51 * scale * (high - low).y));
}

Scene make_smoke(float alpha) {
    Scene scene;
    const float tints[surfaces][3] = {
        {0.75F, 0.72F, 0.68F}, {0.80F, 0.38F, 0.10F}, {0.16F, 0.42F, 0.70F}, {0.62F, 0.60F, 0.58F}};
    for (int i = 0; i < surfaces; ++i) {
        Material material = glass(alpha);
        std::copy_n(tints[i], 3, material.front_tint);
        std::copy_n(tints[i], 3, material.back_tint);
        material.gloss = 0.1F;
        scene.materials.push_back(material);
        scene.models.push_back(model_of(Trace(0.10 + 0.10 * i)));
        scene.instances.push_back(
            {.model = scene.models.size() - 1, .material = scene.materials.size() - 1});
    }
    fit(scene);
    return scene;
}

const SceneRegistration smoke_scene(
    {.name = "smoke",
     .summary = "smoke surfaces whose opacity falls as the flow stretches them",
     .make = make_smoke});

}  // namespace
}  // namespace oit
