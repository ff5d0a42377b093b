#include "reference.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace triangle_grid {
namespace {

// The sign of six times the volume of the tetrahedron, or 0 where rounding could have changed it.
int side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const glm::dvec3 x = b - a, y = c - a, z = d - a;
    double volume = 0;
    double size = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double left = y[j] * z[k], right = y[k] * z[j];
        volume += x[i] * (left - right);
        size += std::abs(x[i]) * (std::abs(left) + std::abs(right));
    }
    if (std::abs(volume) <= 0x1p-50 * size) return 0;
    return volume > 0 ? 1 : -1;
}

bool meets(const glm::dvec3& from, const glm::dvec3& to, const grid::GridTriangle& triangle) {
    const glm::dvec3 a(triangle.a), b(triangle.b), c(triangle.c);
    // The ends on different sides of the plane, or one of them in it.
    const int start = side(a, b, c, from);
    const int end = side(a, b, c, to);
    if (start == end || (start != 0 && end != 0 && start != -end)) return false;
    // The edges on the same side of the line, or some of them crossing it.
    const auto [least, most] =
        std::minmax({side(a, b, from, to), side(b, c, from, to), side(c, a, from, to)});
    return least >= 0 || most <= 0;
}

// The boxes are apart: most triangles are, and no rounding is involved.
bool are_apart(const Segment& segment, const grid::GridTriangle& triangle) {
    for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({triangle.a[k], triangle.b[k], triangle.c[k]});
        if (std::max(segment.from[k], segment.to[k]) < low) return true;
        if (std::min(segment.from[k], segment.to[k]) > high) return true;
    }
    return false;
}

}  // namespace

bool meets_any(const Segment& segment, std::span<const grid::GridTriangle> triangles) {
    const glm::dvec3 from(segment.from), to(segment.to);
    return std::any_of(triangles.begin(), triangles.end(), [&](const auto& triangle) {
        return !are_apart(segment, triangle) && meets(from, to, triangle);
    });
}

}  // namespace triangle_grid
