// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "build.hpp"

namespace motion {

/// The bones of a figure. Each bone of the left side, at +x, comes before that of the right side.
enum Bone : std::size_t {
    pelvis,
    chest,
    head,
    upper_arm,
    forearm = upper_arm + 2,
    thigh = forearm + 2,
    shin = thigh + 2,
    foot = shin + 2,
    bone_count = foot + 2,
};

/// A foot, relative to where it stands in the rest pose.
struct FootPose {
    glm::dvec3 move{0};        ///< of the ankle
    double pitch_degrees = 0;  ///< positive points the toes down
};

/// Angles are in degrees; they are positive where the upper end of a bone turns forward, to +z.
/// Arrays hold the left side, then the right side.
struct Pose {
    glm::dvec3 pelvis_move{0};
    double pelvis_turn = 0;               ///< around y; positive brings the right hip forward
    double lean = 0;                      ///< of the chest
    double chest_turn = 0;                ///< around y; positive brings the right shoulder forward
    std::array<double, 2> arm_forward{};  ///< how far the arms swing forward
    std::array<double, 2> elbow{};        ///< how far the elbows bend
    std::array<FootPose, 2> feet;
};

/// Where each bone goes from the rest pose.
using BonePlaces = std::array<glm::dmat4, bone_count>;

/// The places of the bones in a pose. The knees bend so that thighs and shins reach the feet.
[[nodiscard]] BonePlaces place_bones(const Pose& pose);

/// A person of 1.8 m in a rest pose, legs and arms apart, who looks along +z and stands at y = 0.
struct Figure {
    Shape skin;
    std::vector<std::array<float, bone_count>> weights;  ///< of the bones at each vertex; sum to 1
    std::vector<glm::u8vec4> colours;                    ///< of the triangles
};

/// A figure of about this number of triangles, to within 0.5 %.
[[nodiscard]] Figure make_figure(std::size_t triangles);

/// Where the vertices of the figure are: linear blend skinning.
[[nodiscard]] std::vector<glm::vec3> skin_positions(const Figure& figure, const BonePlaces& places);

}  // namespace motion
