// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "oit/support/screen.hpp"

namespace cellist::test {

/// A convex polygon, in 1/256 pixel.
using Polygon = std::vector<glm::dvec2>;

/// What of a polygon lies where `a * x + b * y + c` is at least 0.
inline Polygon cut(const Polygon& polygon, double a, double b, double c) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double at_p = a * p.x + b * p.y + c, at_q = a * q.x + b * q.y + c;
        if (at_p >= 0) kept.push_back(p);
        if ((at_p >= 0) != (at_q >= 0)) kept.push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
    return kept;
}

/// Twice the signed area.
inline double twice_area(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const glm::dvec2 u = polygon[i] - polygon[0], v = polygon[i + 1] - polygon[0];
        sum += u.x * v.y - u.y * v.x;
    }
    return sum;
}

/// The part of a pixel that a triangle covers, 0 to 1, in double precision: the triangle is cut by
/// the sides of the pixel. `x` and `y` count pixels from the upper left of an image.
inline double covered_part(Point a, Point b, Point c, int x, int y, int width, int height) {
    // From the pixel's upper left corner.
    const glm::dvec2 corner(256 * x - 128 * width, 256 * y - 128 * height);
    Polygon polygon;
    for (const Point& p : {a, b, c}) polygon.push_back(glm::dvec2(p.x, p.y) - corner);
    polygon = cut(polygon, 1, 0, 0);
    polygon = cut(polygon, -1, 0, 256);
    polygon = cut(polygon, 0, 1, 0);
    polygon = cut(polygon, 0, -1, 256);
    return std::abs(twice_area(polygon)) / (2 * 65536.0);
}

}  // namespace cellist::test
