// SPDX-License-Identifier: MIT
// Instances of one mesh: 64 rings of glass in a cube, each turned another way.
#include <numbers>

#include <glm/ext/matrix_transform.hpp>

#include "scene/scenes.hpp"
#include "scene/shapes.hpp"

namespace oit {
namespace {

Scene make(float alpha) {
    constexpr int side = 4;
    Scene scene;
    scene.models.push_back({.mesh = ring(0.2, 0.05, 48, 16)});
    scene.materials.push_back(glass(alpha));
    for (int i = 0; i < side * side * side; ++i) {
        const glm::dvec3 cell(i % side, i / side % side, i / (side * side));
        const glm::dmat4 moved =
            glm::translate(glm::dmat4(1), 0.28 * (cell - glm::dvec3(0.5 * (side - 1))));
        scene.instances.push_back(
            {.to_world = glm::rotate(moved, std::numbers::phi * i, glm::dvec3(1, 0.5, 0.25))});
    }
    return scene;
}

const SceneRegistration rings({.name = "rings", .summary = "64 instances of a ring", .make = make});

}  // namespace
}  // namespace oit
