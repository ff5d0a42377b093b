// SPDX-License-Identifier: MIT
#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace cellist::test {
namespace {

// Coefficients of 1, t, t^2, t^3.
using Polynomial = std::array<double, 4>;

double value(const Polynomial& p, double t) { return p[0] + t * (p[1] + t * (p[2] + t * p[3])); }

// The places from 0 to 1 where the sign may change: between two of them it does not.
std::vector<double> sign_changes(const Polynomial& p, int degree) {
    std::vector<double> ends{0};
    if (degree > 1) {
        const Polynomial derivative{p[1], 2 * p[2], 3 * p[3], 0};
        const std::vector<double> turns = sign_changes(derivative, degree - 1);
        ends.insert(ends.end(), turns.begin(), turns.end());
    }
    ends.push_back(1);
    std::vector<double> roots;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        double low = ends[i], high = ends[i + 1];
        const bool starts_positive = value(p, low) >= 0;
        if (starts_positive == (value(p, high) >= 0)) continue;
        for (;;) {
            const double middle = 0.5 * (low + high);
            if (middle <= low || middle >= high) break;
            ((value(p, middle) >= 0) == starts_positive ? low : high) = middle;
        }
        roots.push_back(high);
    }
    return roots;
}

// a + t * b
struct Line {
    double a, b;
};

Polynomial product(const Line& x, const Line& y) {
    return {x.a * y.a, x.a * y.b + x.b * y.a, x.b * y.b, 0};
}

Polynomial product(const Polynomial& quadratic, const Line& y) {
    Polynomial p{};
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] += quadratic[i] * y.a;
        p[i + 1] += quadratic[i] * y.b;
    }
    return p;
}

Polynomial sum(const Polynomial& p, const Polynomial& q, double factor = 1) {
    Polynomial s;
    for (std::size_t i = 0; i < 4; ++i) s[i] = p[i] + factor * q[i];
    return s;
}

// A coordinate of a vertex relative to a place.
Line relative(const DoubleVertex& v, const glm::dvec2& place, int axis) {
    const double begin = v.begin[axis] - place[axis] * v.begin.z;
    return {begin, v.end[axis] - place[axis] * v.end.z - begin};
}

Polynomial edge_function(const DoubleTriangle& t, const glm::dvec2& place, std::size_t opposite) {
    const DoubleVertex& v = t.vertex[(opposite + 1) % 3];
    const DoubleVertex& w = t.vertex[(opposite + 2) % 3];
    return sum(product(relative(v, place, 0), relative(w, place, 1)),
               product(relative(v, place, 1), relative(w, place, 0)), -1);
}

Line line(double begin, double end) { return {begin, end - begin}; }

}  // namespace

std::vector<DoubleVertex> exactly(std::span<const motion::MovingVertex> vertices) {
    const auto wide = [](const cl_float4& v) { return glm::dvec4(v.s[0], v.s[1], v.s[2], v.s[3]); };
    std::vector<DoubleVertex> exact;
    exact.reserve(vertices.size());
    for (const motion::MovingVertex& v : vertices) exact.push_back({wide(v.begin), wide(v.end)});
    return exact;
}

std::vector<DoubleVertex> projected(const motion::Scene& scene, const motion::View& view) {
    const auto project = [&](const glm::vec3& position) {
        const auto row = [&](const cl_float4& r) {
            return glm::dot(glm::dvec4(r.s[0], r.s[1], r.s[2], r.s[3]), glm::dvec4(position, 1));
        };
        return glm::dvec4(row(view.row_x), row(view.row_y), row(view.row_w), row(view.row_depth));
    };
    std::vector<DoubleVertex> vertices;
    for (std::size_t i = 0; i < scene.begin.size(); ++i)
        vertices.push_back({project(scene.begin[i]), project(scene.end[i])});
    return vertices;
}

DoubleTriangle triangle_of(std::span<const DoubleVertex> vertices, const glm::uvec3& corners) {
    return {{vertices[corners.x], vertices[corners.y], vertices[corners.z]}};
}

glm::dvec2 centre_of(const motion::View& view, std::size_t pixel) {
    const auto width = static_cast<std::size_t>(view.width);
    return {static_cast<double>(pixel % width) + 0.5 - 0.5 * view.width,
            static_cast<double>(pixel / width) + 0.5 - 0.5 * view.height};
}

Times covered_times(const DoubleTriangle& triangle, const glm::dvec2& place) {
    std::array<Polynomial, 3> edges;
    std::vector<double> ends{0, 1};
    for (std::size_t k = 0; k < 3; ++k) {
        edges[k] = edge_function(triangle, place, k);
        const std::vector<double> roots = sign_changes(edges[k], 2);
        ends.insert(ends.end(), roots.begin(), roots.end());
    }
    std::sort(ends.begin(), ends.end());
    Times times;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (ends[i] == ends[i + 1]) continue;
        const double middle = 0.5 * (ends[i] + ends[i + 1]);
        const int positive =
            static_cast<int>(std::count_if(edges.begin(), edges.end(), [&](const Polynomial& e) {
                return value(e, middle) >= 0;
            }));
        if (positive == 0 || positive == 3) times.emplace_back(ends[i], ends[i + 1]);
    }
    return times;
}

Times nearer_times(const DoubleTriangle& triangle, const glm::dvec2& place, const Times& times,
                   double nearest, double limit) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const DoubleVertex& v : triangle.vertex) {
        least = std::min({least, v.begin.w, v.end.w});
        most = std::max({most, v.begin.w, v.end.w});
    }
    if (least >= limit || most < nearest) return {};
    if (least >= nearest && most < limit) return times;
    // Depth is numerator / weight.
    Polynomial numerator{}, weight{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Polynomial edge = edge_function(triangle, place, k);
        weight = sum(weight, edge);
        numerator = sum(numerator,
                        product(edge, line(triangle.vertex[k].begin.w, triangle.vertex[k].end.w)));
    }
    const Polynomial over_limit = sum(numerator, weight, -limit);
    const Polynomial over_nearest = sum(numerator, weight, -nearest);
    std::vector<double> cuts = sign_changes(over_limit, 3);
    const std::vector<double> others = sign_changes(over_nearest, 3);
    cuts.insert(cuts.end(), others.begin(), others.end());
    std::sort(cuts.begin(), cuts.end());
    Times parts;
    for (const auto& [begin, end] : times) {
        double from = begin;
        const auto add = [&](double to) {
            if (!(to > from)) return;
            const double middle = 0.5 * (from + to);
            const bool sign = value(weight, middle) >= 0;
            if ((value(over_limit, middle) >= 0) != sign &&
                (value(over_nearest, middle) >= 0) == sign)
                parts.emplace_back(from, to);
            from = to;
        };
        for (const double cut : cuts)
            if (cut > begin && cut < end) add(cut);
        add(end);
    }
    return parts;
}

double total(Times times) {
    std::sort(times.begin(), times.end());
    double sum = 0, reached = 0;
    for (const auto& [begin, end] : times) {
        sum += std::max(0.0, end - std::max(begin, reached));
        reached = std::max(reached, end);
    }
    return sum;
}

Moment at_moment(const DoubleTriangle& triangle, const glm::dvec2& place, double time) {
    std::array<glm::dvec4, 3> v;
    for (std::size_t k = 0; k < 3; ++k)
        v[k] = glm::mix(triangle.vertex[k].begin, triangle.vertex[k].end, time);
    double weight = 0, depth = 0, least = std::numeric_limits<double>::infinity();
    int positive = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec4 &a = v[(k + 1) % 3], &b = v[(k + 2) % 3];
        const glm::dvec2 p(a.x - place.x * a.z, a.y - place.y * a.z);
        const glm::dvec2 q(b.x - place.x * b.z, b.y - place.y * b.z);
        const double edge = p.x * q.y - p.y * q.x;
        positive += edge >= 0 ? 1 : 0;
        weight += edge;
        depth += edge * v[k].w;
        // The gradient of the edge function over the place is about this long.
        const glm::dvec2 gradient(p.y * b.z - a.z * q.y, a.z * q.x - p.x * b.z);
        least = std::min(least, std::abs(edge) / std::max(glm::length(gradient), 1e-300));
    }
    return {positive == 0 || positive == 3 ? least : -least, depth / weight};
}

TriangleGrid::TriangleGrid(std::span<const DoubleVertex> vertices,
                           std::span<const glm::uvec3> triangles, const motion::View& view)
    : width_(view.width),
      columns_((view.width - 1) / side + 1),
      squares_(static_cast<std::size_t>(columns_) *
               static_cast<std::size_t>((view.height - 1) / side + 1)) {
    const glm::dvec2 half(0.5 * view.width, 0.5 * view.height);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
        bool in_front = true, finite = true;
        for (int k = 0; k < 3; ++k)
            for (const glm::dvec4& v :
                 {vertices[triangles[i][k]].begin, vertices[triangles[i][k]].end}) {
                finite = finite && std::isfinite(v.x + v.y + v.z + v.w);
                in_front = in_front && v.z > 1e-6;
                low = glm::min(low, glm::dvec2(v) / v.z);
                high = glm::max(high, glm::dvec2(v) / v.z);
            }
        if (!finite) continue;
        if (!in_front) low = -(high = half);
        const glm::dvec2 first = glm::max(low + half - 1.0, 0.0);
        const glm::dvec2 last = glm::min(high + half + 1.0, 2.0 * half - 1.0);
        if (first.x > last.x || first.y > last.y) continue;
        for (int y = int(first.y) / side; y <= int(last.y) / side; ++y)
            for (int x = int(first.x) / side; x <= int(last.x) / side; ++x)
                squares_[static_cast<std::size_t>(y * columns_ + x)].push_back(
                    static_cast<std::uint32_t>(i));
    }
}

std::span<const std::uint32_t> TriangleGrid::near(std::size_t pixel) const {
    const int x = static_cast<int>(pixel) % width_, y = static_cast<int>(pixel) / width_;
    return squares_[static_cast<std::size_t>(y / side * columns_ + x / side)];
}

}  // namespace cellist::test
