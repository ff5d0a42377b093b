// SPDX-License-Identifier: MIT
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "scene/mesh_materials.hpp"

namespace oit {
namespace {

support::Mesh floor_mesh(const Lighting& lighting) {
    const float side = 2 * lighting.floor_fade_end;
    support::Mesh floor;
    for (const float z : {-side, side})
        for (const float x : {-side, side}) {
            floor.positions.emplace_back(x, lighting.floor_height, z);
            floor.normals.emplace_back(0.0F, 1.0F, 0.0F);
        }
    floor.triangles = {{0, 2, 3}, {0, 3, 1}};
    return floor;
}

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    [[nodiscard]] bool is_empty() const { return !(low.x <= high.x); }
};

// Around all instances, as they stand at time 0.
Box box_around(const Scene& scene) {
    Box box;
    for (const Instance& instance : scene.instances)
        for (const glm::vec3& p : scene.models.at(instance.model).mesh.positions)
            if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))
                box.add(instance.to_world * glm::dvec4(p, 1));
    return box;
}

float floor_height_under(const Scene& scene) {
    // A flat underside that lay in the floor would fight with it for the same depth.
    constexpr float sunk = 0.02F;
    const Box box = box_around(scene);
    if (box.is_empty()) return -1;
    const auto lowest = static_cast<float>(box.low.y), highest = static_cast<float>(box.high.y);
    return lowest + sunk * (highest - lowest);
}

// An ellipse around what stands on the floor, and somewhat larger.
void fit_shadow(Lighting& lighting, const Box& box) {
    constexpr double wider = 1.25, least = 0.05;
    if (box.is_empty()) return;
    const auto fit = [&](int shadow_axis, int axis) {
        lighting.floor_shadow_centre[shadow_axis] =
            static_cast<cl_float>((box.low[axis] + box.high[axis]) / 2);
        lighting.floor_shadow_radius[shadow_axis] =
            static_cast<cl_float>(std::max(least, wider * (box.high[axis] - box.low[axis]) / 2));
    };
    fit(0, 0);
    fit(1, 2);
}

}  // namespace

std::uint64_t Scene::triangles() const {
    std::uint64_t sum = 0;
    for (const Instance& instance : instances)
        sum += models.at(instance.model).mesh.triangles.size();
    return sum;
}

glm::dmat4 transform_at(const Instance& instance, double time) {
    if (instance.turns_per_second == 0) return instance.to_world;
    const double angle = 2 * std::numbers::pi * instance.turns_per_second * time;
    return glm::rotate(instance.to_world, angle, glm::dvec3(0, 0, 1));
}

Material glass(float alpha) {
    return {.front_tint = {0.03F, 0.46F, 0.66F},
            .back_tint = {0.78F, 0.10F, 0.42F},
            .alpha = alpha,
            .gloss = 0.5F,
            .blend = static_cast<cl_uint>(Blend::over),
            .paint = static_cast<cl_uint>(Paint::shaded)};
}

void add_floor(Scene& scene) {
    fit_shadow(scene.lighting, box_around(scene));
    scene.instances.push_back({.model = scene.models.size(), .material = scene.materials.size()});
    scene.models.push_back({.mesh = floor_mesh(scene.lighting)});
    Material material = glass(1);
    material.blend = static_cast<cl_uint>(Blend::opaque);
    material.paint = static_cast<cl_uint>(Paint::floor);
    scene.materials.push_back(material);
}

Scene scene_of(std::vector<PlacedMesh> meshes) {
    Scene scene;
    for (PlacedMesh& placed : meshes)
        add_mesh(scene, std::move(placed.mesh), placed.alpha, placed.own_alpha);
    scene.lighting = studio_lighting(floor_height_under(scene));
    return scene;
}

Scene scene_of(support::Mesh mesh, float alpha) {
    std::vector<PlacedMesh> meshes;
    meshes.push_back({.mesh = std::move(mesh), .alpha = alpha});
    return scene_of(std::move(meshes));
}

}  // namespace oit
