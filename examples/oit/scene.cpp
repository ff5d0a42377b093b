#include "scene.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <glm/ext/matrix_transform.hpp>

namespace oit {
namespace {

support::Mesh floor_mesh(const Look& look) {
    const float side = 2 * look.floor_fade_end;
    support::Mesh floor;
    for (const float z : {-side, side})
        for (const float x : {-side, side}) {
            floor.positions.emplace_back(x, look.floor_height, z);
            floor.normals.emplace_back(0.0F, 1.0F, 0.0F);
        }
    floor.triangles = {{0, 2, 3}, {0, 3, 1}};
    return floor;
}

float floor_height_under(const support::Mesh& mesh) {
    // A flat underside that lay in the floor would fight with it for the same depth.
    constexpr float sunk = 0.02F;
    if (mesh.positions.empty()) return -1;
    const auto lower = [](const glm::vec3& a, const glm::vec3& b) { return a.y < b.y; };
    const auto [lowest, highest] =
        std::minmax_element(mesh.positions.begin(), mesh.positions.end(), lower);
    return lowest->y + sunk * (highest->y - lowest->y);
}

}  // namespace

std::uint64_t Scene::triangles() const {
    std::uint64_t sum = 0;
    for (const Instance& instance : instances)
        sum += models.at(instance.model).mesh.triangles.size();
    return sum;
}

glm::dmat4 place_at(const Instance& instance, double time) {
    if (instance.turns_per_second == 0) return instance.place;
    const double angle = 2 * std::numbers::pi * instance.turns_per_second * time;
    return glm::rotate(instance.place, angle, glm::dvec3(0, 0, 1));
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
    scene.instances.push_back({.model = scene.models.size(), .material = scene.materials.size()});
    scene.models.push_back({.mesh = floor_mesh(scene.look)});
    Material material = glass(1);
    material.blend = static_cast<cl_uint>(Blend::opaque);
    material.paint = static_cast<cl_uint>(Paint::floor);
    scene.materials.push_back(material);
}

Scene scene_of(support::Mesh mesh, float alpha) {
    Scene scene;
    scene.look = studio_look(floor_height_under(mesh));
    scene.models.push_back({.mesh = std::move(mesh)});
    scene.materials.push_back(glass(alpha));
    scene.instances.push_back({});
    return scene;
}

}  // namespace oit
