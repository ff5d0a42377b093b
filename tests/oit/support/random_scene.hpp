// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "oit/support/procedural.hpp"
#include "scene/scene.hpp"

namespace cellist::test {

/// A knot, and around it triangles of any size, opacity and colour in any direction, of all of
/// `blends` in turn; every second scene stands on a floor.
inline oit::Scene random_scene(std::uint32_t seed, const std::vector<oit::Blend>& blends,
                               int triangles = 40) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto direction = [&] {
        glm::vec3 v;
        do v = {2 * unit(random) - 1, 2 * unit(random) - 1, 2 * unit(random) - 1};
        while (glm::length(v) > 1 || glm::length(v) < 0.1F);
        return v;
    };
    oit::Scene scene = oit::scene_of(torus_knot(2, 3, 60, 8), 0.1F + 0.8F * unit(random));
    scene.materials.front().blend = static_cast<cl_uint>(blends.front());
    for (std::size_t i = 0; i < blends.size(); ++i) {
        oit::Material material = oit::glass(unit(random));
        for (int c = 0; c < 3; ++c) {
            material.front_tint[c] = unit(random);
            material.back_tint[c] = unit(random);
        }
        material.blend = static_cast<cl_uint>(blends[i]);
        scene.materials.push_back(material);
        support::Mesh mesh;
        for (int t = 0; t < triangles; ++t) {
            const glm::vec3 middle = 0.6F * direction();
            const glm::vec3 normal = glm::normalize(direction());
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (int corner = 0; corner < 3; ++corner) {
                mesh.positions.push_back(middle + 0.3F * direction());
                mesh.normals.push_back(normal);
            }
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        scene.models.push_back({.mesh = mesh});
        if (i % 2 == 1)
            for (std::size_t v = 0; v < mesh.positions.size(); ++v)
                scene.models.back().opacities.push_back(unit(random));
        scene.instances.push_back(
            {.model = scene.models.size() - 1, .material = scene.materials.size() - 1});
    }
    if (seed % 2 == 1) oit::add_floor(scene);
    return scene;
}

}  // namespace cellist::test
