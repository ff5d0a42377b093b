#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "mesh.hpp"

namespace oit {

/// How a surface looks where its parts meet.
enum class Corners { sharp, round };

/// A part of a circle, from one angle to another, of `parts` straight parts.
[[nodiscard]] std::vector<glm::dvec2> arc(const glm::dvec2& centre, double radius, double begin,
                                          double end, int parts);

/// Turns a profile of points (radius, z) about the z axis. The outside is to the right of its
/// direction: of one that runs up, away from the axis. A closed profile ends with the point that it
/// starts with. 2 * segments triangles for each part of the profile, half of them where it starts or
/// ends on the axis.
[[nodiscard]] support::Mesh lathe(std::span<const glm::dvec2> profile, int segments,
                                  Corners corners);

/// The same with a circle for the profile: a ball, or a ring.
[[nodiscard]] support::Mesh ball(double radius, int segments);
[[nodiscard]] support::Mesh ring(double radius, double wire_radius, int segments,
                                 int wire_segments);

/// A tube from z = low to high with walls between two radii.
[[nodiscard]] support::Mesh sleeve(double inner, double outer, double low, double high,
                                   int segments);

struct Gear {
    int teeth;
    double pitch_radius;  ///< two gears mesh at the distance of the sum of theirs
    double tooth_height;  ///< from root to tip
    double bore_radius;
    double thickness;       ///< centred on z = 0
    int tooth_points = 10;  ///< of the outline of each tooth; 8 triangles each
};

/// A spur gear about the z axis; the middle of its first tooth is in the direction of x.
[[nodiscard]] support::Mesh gear(const Gear& shape);

struct Spring {
    double radius, wire_radius;
    double low, high;
    int turns;
};

/// A coil spring about the z axis, of exactly this many triangles (at least 60).
[[nodiscard]] support::Mesh spring(const Spring& shape, std::size_t triangles);

}  // namespace oit
