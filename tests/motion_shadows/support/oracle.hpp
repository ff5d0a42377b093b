// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "device_types.hpp"
#include "scene.hpp"

namespace cellist::test {

/// A vertex in a view, as motion::MovingVertex: x * w, y * w, w, depth.
struct DoubleVertex {
    glm::dvec4 begin, end;
};

/// What a view sees of a moving triangle, in double precision. The kernels use the Bernstein basis
/// and closed formulas. This code uses the power basis and bisection.
struct DoubleTriangle {
    std::array<DoubleVertex, 3> vertex;
};

/// The vertices that a kernel projected in float; those projected here in double, from positions.
[[nodiscard]] std::vector<DoubleVertex> exactly(std::span<const motion::MovingVertex> vertices);
[[nodiscard]] std::vector<DoubleVertex> projected(const motion::Scene& scene,
                                                  const motion::View& view);

[[nodiscard]] DoubleTriangle triangle_of(std::span<const DoubleVertex> vertices,
                                         const glm::uvec3& corners);

/// The centre of a pixel or texel, in pixels from the centre of the image.
[[nodiscard]] glm::dvec2 centre_of(const motion::View& view, std::size_t pixel);

/// From `first` to before `second`.
using Times = std::vector<std::pair<double, double>>;

/// When a triangle covers a place, in order.
[[nodiscard]] Times covered_times(const DoubleTriangle& triangle, const glm::dvec2& place);

/// The parts of `times` in which the triangle's plane has a depth from `nearest` to before
/// `limit`.
[[nodiscard]] Times nearer_times(const DoubleTriangle& triangle, const glm::dvec2& place,
                                 const Times& times, double nearest, double limit);

/// The length of the union.
[[nodiscard]] double total(Times times);

/// A triangle at one time and place.
struct Moment {
    double inside;  ///< the distance to the nearest edge, in pixels; negative outside
    double depth;   ///< of its plane
};
[[nodiscard]] Moment at_moment(const DoubleTriangle& triangle, const glm::dvec2& place,
                               double time);

/// The triangles that may touch each square of pixels, so that not all have to be tried.
class TriangleGrid {
public:
    TriangleGrid(std::span<const DoubleVertex> vertices, std::span<const glm::uvec3> triangles,
                 const motion::View& view);
    [[nodiscard]] std::span<const std::uint32_t> near(std::size_t pixel) const;

private:
    static constexpr int side = 4;
    int width_, columns_;
    std::vector<std::vector<std::uint32_t>> squares_;
};

}  // namespace cellist::test
