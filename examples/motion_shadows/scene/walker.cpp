// SPDX-License-Identifier: MIT
#include <string>

#include "build.hpp"
#include "figure.hpp"
#include "input_error.hpp"
#include "scene.hpp"

namespace motion {
namespace {

// The left leg swings forward; the right foot stands.
constexpr Pose begin_pose() {
    return {
        .pelvis_move = {0, -0.02, 0},
        .pelvis_turn = 4,
        .lean = 4,
        .chest_turn = -6,
        .arm_forward = {22, -18},
        .elbow = {26, 12},
        .feet = {{{.move = {-0.04, 0.15, -0.17}, .pitch_degrees = 38}, {.move = {0.03, 0, 0}}}}};
}

constexpr Pose end_pose() {
    return {.pelvis_move = {0, -0.02, 0.14},
            .pelvis_turn = -6,
            .lean = 7,
            .chest_turn = 8,
            .arm_forward = {-22, 26},
            .elbow = {12, 32},
            .feet = {{{.move = {-0.04, 0.05, 0.4}, .pitch_degrees = -18}, {.move = {0.03, 0, 0}}}}};
}

}  // namespace

Scene make_walker(std::size_t triangles) {
    constexpr std::size_t least = 12'000, most = 1'000'000;
    if (triangles < least || triangles > most)
        throw support::InputError("a walker of " + std::to_string(triangles) +
                                  " triangles: give 12000 to 1000000");
    Scene scene;
    scene.name = "walker";
    add_ground(scene, {0.1, -0.95}, {3, 4.5});
    const Figure figure = make_figure(triangles - scene.triangles.size());
    const auto first = static_cast<std::uint32_t>(scene.begin.size());
    for (const glm::uvec3& t : figure.skin.triangles) scene.triangles.push_back(first + t);
    scene.colours.insert(scene.colours.end(), figure.colours.begin(), figure.colours.end());
    const auto append = [](std::vector<glm::vec3>& to, const std::vector<glm::vec3>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(scene.begin, skin_positions(figure, place_bones(begin_pose())));
    append(scene.end, skin_positions(figure, place_bones(end_pose())));
    aim_light(scene, {0.9, 4, 3.8}, {0, 0.8, 0});
    scene.eye = {3.2, 1.8, 3.1};
    scene.target = {0.1, 0.8, -0.25};
    scene.field_degrees = 29;
    return scene;
}

}  // namespace motion
