// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "mesh.hpp"

namespace oit {

inline constexpr double full_turn = 2 * std::numbers::pi;  ///< in radians

/// How a surface looks where its parts meet.
enum class Corners { sharp, round };

/// A part of a circle, from one angle to another, of `parts` straight parts.
[[nodiscard]] std::vector<glm::dvec2> arc(const glm::dvec2& centre, double radius, double begin,
                                          double end, int parts);

/// The same profile with the parts that are longer than `longest` divided evenly.
[[nodiscard]] std::vector<glm::dvec2> divided(std::span<const glm::dvec2> profile, double longest);

/// Turns a profile of points (radius, z) about the z axis. The outside is to the right of its
/// direction: of one that runs up, away from the axis. A closed profile ends with the point that it
/// starts with. 2 * segments triangles for each part of the profile, half of them where it starts
/// or ends on the axis.
[[nodiscard]] support::Mesh lathe(std::span<const glm::dvec2> profile, int segments,
                                  Corners corners);

/// The same with a circle for the profile: a ball, or a ring.
[[nodiscard]] support::Mesh ball(double radius, int segments);
[[nodiscard]] support::Mesh ring(double radius, double wire_radius, int segments,
                                 int wire_segments);

/// A tube from z = low to high with walls between two radii, its profile divided as by divided().
[[nodiscard]] support::Mesh sleeve(double inner, double outer, double low, double high,
                                   int segments, double longest);

/// A toothed rim on a thinner web with a hole in its middle.
struct Gear {
    int teeth;
    double pitch_radius;  ///< two gears mesh at the distance of the sum of theirs
    double tooth_height;  ///< from root to tip
    double rim_radius;    ///< inside of the rim
    double bore_radius;
    double thickness;       ///< of the rim, centred on z = 0
    int tooth_points = 10;  ///< of the outline of each tooth; 8 triangles each
    int web_segments = 48;
};

/// A spur gear about the z axis; the middle of its first tooth is in the direction of x.
[[nodiscard]] support::Mesh gear(const Gear& shape);

struct Spring {
    double radius, wire_radius;
    double low, high;
    int turns;
};

/// A coil spring about the z axis, of exactly this many triangles: from 60 to 10^7. Throws
/// std::invalid_argument at other numbers.
[[nodiscard]] support::Mesh spring(const Spring& shape, std::size_t triangles);

}  // namespace oit
