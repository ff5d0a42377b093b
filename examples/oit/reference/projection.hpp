// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "raster/view.hpp"

namespace oit {

/// The reference's own projection and clipping, which shares no code with the rasteriser's.
///
/// Where vertices snap to sub-pixels is part of the definition of a picture. Projection<float>
/// computes these positions as the rasteriser documents them: a fused multiplication and addition
/// at a time, each rounded to float. Projection<double> computes what the definition approximates;
/// a test compares them.
template <class Real>
class Projection {
public:
    struct Vertex {
        Real x, y, w;                ///< clip coordinates: see raster/definitions.h
        std::array<Real, 3> shares;  ///< of the triangle's corners
    };

    /// The part of a triangle in front of the near plane and within the guard band: a convex
    /// polygon.
    class Polygon {
    public:
        void add(const Vertex& vertex) { vertices_.at(size_++) = vertex; }
        [[nodiscard]] std::size_t size() const { return size_; }
        [[nodiscard]] const Vertex& operator[](std::size_t i) const { return vertices_[i]; }

    private:
        std::array<Vertex, 8> vertices_{};
        std::size_t size_ = 0;
    };

    Projection(const glm::dmat4& to_world, const raster::View& view) : view_(view) {
        for (int i = 0; i < 4; ++i) {
            double x = 0, y = 0, w = 0;
            for (int k = 0; k < 4; ++k) {
                x += static_cast<double>(view.row_x[k]) * to_world[i][k];
                y += static_cast<double>(view.row_y[k]) * to_world[i][k];
                w += static_cast<double>(view.row_w[k]) * to_world[i][k];
            }
            const auto at = static_cast<std::size_t>(i);
            row_x_[at] = static_cast<Real>(x);
            row_y_[at] = static_cast<Real>(y);
            row_w_[at] = static_cast<Real>(w);
        }
        // Normals turn with the adjugate matrix. Its scale is that of the mesh.
        const glm::dmat3 m(to_world);
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
                normal_[i][k] = m[(i + 1) % 3][(k + 1) % 3] * m[(i + 2) % 3][(k + 2) % 3] -
                                m[(i + 1) % 3][(k + 2) % 3] * m[(i + 2) % 3][(k + 1) % 3];
        const double determinant =
            m[0][0] * normal_[0][0] + m[0][1] * normal_[0][1] + m[0][2] * normal_[0][2];
        if (determinant != 0) normal_ /= std::cbrt(determinant * determinant);
    }

    [[nodiscard]] const raster::View& view() const { return view_; }

    /// A normal of the mesh in the world. Its length need not be 1.
    [[nodiscard]] glm::dvec3 normal(const glm::dvec3& of_mesh) const { return normal_ * of_mesh; }

    [[nodiscard]] Polygon clipped(const std::array<glm::vec3, 3>& triangle) const {
        Polygon polygon;
        for (std::size_t j = 0; j < 3; ++j) {
            Vertex corner{row(row_x_, triangle[j]),
                          row(row_y_, triangle[j]),
                          row(row_w_, triangle[j]),
                          {0, 0, 0}};
            corner.shares[j] = 1;
            polygon.add(corner);
        }
        for (const Plane& plane : planes) polygon = cut(polygon, plane);
        return polygon;
    }

    /// Sub-pixels from the upper left corner of the image, before they are rounded.
    [[nodiscard]] std::array<Real, 2> position(const Vertex& vertex) const {
        return {vertex.x / vertex.w, vertex.y / vertex.w};
    }

private:
    using Row = std::array<Real, 4>;

    /// The near plane, or a side of the guard band: where `coordinate` is `side` times the guard.
    struct Plane {
        Real Vertex::*coordinate;
        Real side;
    };
    static constexpr std::array<Plane, 5> planes{
        {{nullptr, 0}, {&Vertex::x, 1}, {&Vertex::x, -1}, {&Vertex::y, 1}, {&Vertex::y, -1}}};
    static constexpr Real guard = static_cast<Real>(RASTER_GUARD);

    [[nodiscard]] static Real row(const Row& r, const glm::vec3& p) {
        Real sum = r[3];
        for (const auto& [factor, value] :
             {std::pair{r[2], p.z}, std::pair{r[1], p.y}, std::pair{r[0], p.x}})
            sum = std::fma(factor, static_cast<Real>(value), sum);
        return sum;
    }

    /// At least 0 inside.
    [[nodiscard]] Real distance(const Vertex& v, const Plane& plane) const {
        if (!plane.coordinate) return v.w - static_cast<Real>(view_.near_depth);
        return std::fma(guard, v.w, -plane.side * v.*plane.coordinate);
    }

    /// The point of the plane on an edge, found from the inner end.
    [[nodiscard]] Vertex crossing(const Vertex& inner, const Vertex& outer,
                                  const Plane& plane) const {
        const Real inside = distance(inner, plane);
        const Real part = inside / (inside - distance(outer, plane));
        const auto between = [part](Real a, Real b) { return std::fma(part, b - a, a); };
        Vertex v{
            between(inner.x, outer.x), between(inner.y, outer.y), between(inner.w, outer.w), {}};
        for (std::size_t j = 0; j < 3; ++j) v.shares[j] = between(inner.shares[j], outer.shares[j]);
        if (plane.coordinate)
            v.*plane.coordinate = plane.side * guard * v.w;
        else
            v.w = static_cast<Real>(view_.near_depth);
        return v;
    }

    [[nodiscard]] Polygon cut(const Polygon& polygon, const Plane& plane) const {
        Polygon result;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vertex& here = polygon[i];
            const Vertex& next = polygon[(i + 1) % polygon.size()];
            const bool is_inside = distance(here, plane) >= 0;
            if (is_inside) result.add(here);
            if (is_inside != (distance(next, plane) >= 0))
                result.add(is_inside ? crossing(here, next, plane) : crossing(next, here, plane));
        }
        return result.size() < 3 ? Polygon() : result;
    }

    const raster::View& view_;
    Row row_x_, row_y_, row_w_;
    glm::dmat3 normal_;
};

}  // namespace oit
