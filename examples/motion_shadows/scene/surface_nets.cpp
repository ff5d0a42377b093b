// SPDX-License-Identifier: MIT
#include "surface_nets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace motion {
namespace {

constexpr std::uint32_t none = ~0U;

// The distances at the corners of cells.
class Lattice {
public:
    Lattice(const Solid& solid, double cell)
        : solid_(solid),
          cell_(cell),
          origin_(solid.low - 2 * cell),
          size_(glm::ivec3(glm::ceil((solid.high - solid.low) / cell)) + 5),
          values_(index({0, 0, size_.z})) {
        glm::ivec3 block;
        for (block.z = 0; block.z < size_.z; block.z += side)
            for (block.y = 0; block.y < size_.y; block.y += side)
                for (block.x = 0; block.x < size_.x; block.x += side) fill(block);
    }

    [[nodiscard]] const glm::ivec3& size() const { return size_; }
    [[nodiscard]] std::size_t index(const glm::ivec3& at) const {
        return static_cast<std::size_t>(at.x) +
               static_cast<std::size_t>(size_.x) *
                   (static_cast<std::size_t>(at.y) +
                    static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(at.z));
    }
    [[nodiscard]] float value(const glm::ivec3& at) const { return values_[index(at)]; }
    [[nodiscard]] bool is_crossed(const glm::ivec3& cell) const {
        const bool inside = value(cell) < 0;
        for (int k = 1; k < 8; ++k)
            if ((value(cell + glm::ivec3(k & 1, (k >> 1) & 1, k >> 2)) < 0) != inside) return true;
        return false;
    }
    [[nodiscard]] glm::dvec3 position(const glm::dvec3& at) const { return origin_ + cell_ * at; }

private:
    static constexpr int side = 4;  // of a block

    // Far from the surface, one distance does for a whole block.
    void fill(const glm::ivec3& first) {
        const glm::ivec3 end = glm::min(first + side, size_);
        const double centre = solid_.distance(position(glm::dvec3(first) + 0.5 * (side - 1)));
        // 1.1 times half of the block's diagonal.
        const bool is_far = std::abs(centre) > 0.96 * side * cell_;
        glm::ivec3 at;
        for (at.z = first.z; at.z < end.z; ++at.z)
            for (at.y = first.y; at.y < end.y; ++at.y)
                for (at.x = first.x; at.x < end.x; ++at.x)
                    values_[index(at)] = static_cast<float>(
                        is_far ? centre : solid_.distance(position(glm::dvec3(at))));
    }

    const Solid& solid_;
    double cell_;
    glm::dvec3 origin_;
    glm::ivec3 size_;
    std::vector<float> values_;
};

// An edge of a cell, by its axis and its place along the two axes after that.
constexpr std::size_t edge_of(int axis, int u, int v) {
    return static_cast<std::size_t>(4 * axis + u + 2 * v);
}

// Where the surface crosses a cell. Parts of the surface that do not meet in the cell have vertices
// of their own, so that each edge has two triangles: Nielson, "Dual Marching Cubes" (VIS 2004).
class Crossings {
public:
    Crossings(const Lattice& lattice, const glm::ivec3& cell) : cell_(cell) {
        for (std::size_t k = 0; k < 8; ++k)
            corners_[k] = lattice.value(cell + glm::ivec3(k & 1, (k >> 1) & 1, k >> 2));
        std::iota(part_.begin(), part_.end(), std::size_t{0});
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) connect_on_face(axis, side);
    }

    // Calls `use` with each edge that the surface crosses, the edge that stands for its part, and
    // where the crossing is.
    template <typename Use>
    void for_each(const Use& use) const {
        for (int axis = 0; axis < 3; ++axis)
            for (const int v : {0, 1})
                for (const int u : {0, 1}) {
                    glm::ivec3 corner(0);
                    corner[(axis + 1) % 3] = u;
                    corner[(axis + 2) % 3] = v;
                    const float first = value(corner);
                    glm::dvec3 crossing(cell_ + corner);
                    ++corner[axis];
                    const float second = value(corner);
                    if ((first < 0) == (second < 0)) continue;
                    crossing[axis] += static_cast<double>(first / (first - second));
                    use(edge_of(axis, u, v), part(edge_of(axis, u, v)), crossing);
                }
    }

private:
    [[nodiscard]] float value(const glm::ivec3& corner) const {
        return corners_[static_cast<std::size_t>(corner.x + 2 * corner.y + 4 * corner.z)];
    }
    [[nodiscard]] std::size_t part(std::size_t edge) const {
        while (part_[edge] != edge) edge = part_[edge];
        return edge;
    }
    void connect(std::size_t a, std::size_t b) { part_[part(a)] = part(b); }

    // The surface runs over a face from one crossing to the other. Of four crossings, it connects
    // those beside a corner that is inside.
    void connect_on_face(int axis, int side) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto inside = [&](int i, int j) {
            glm::ivec3 corner;
            corner[axis] = side;
            corner[u] = i;
            corner[v] = j;
            return value(corner) < 0;
        };
        const auto along_u = [&](int j) { return edge_of(u, j, side); };
        const auto along_v = [&](int i) { return edge_of(v, side, i); };
        std::array<std::size_t, 4> crossed{};
        std::size_t count = 0;
        for (const int k : {0, 1}) {
            if (inside(0, k) != inside(1, k)) crossed[count++] = along_u(k);
            if (inside(k, 0) != inside(k, 1)) crossed[count++] = along_v(k);
        }
        if (count == 2) connect(crossed[0], crossed[1]);
        if (count == 4)
            for (const int i : {0, 1}) connect(along_v(i), along_u(inside(i, 0) ? 0 : 1));
    }

    glm::ivec3 cell_;
    std::array<float, 8> corners_{};
    std::array<std::size_t, 12> part_{};
};

// A step of Newton's method from a point near the surface.
glm::dvec3 onto_surface(const Solid& solid, const glm::dvec3& start, double cell) {
    const double step = 0.05 * cell;
    const double distance = solid.distance(start);
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 beside = start;
        beside[axis] += step;
        slope[axis] = (solid.distance(beside) - distance) / step;
    }
    const double square = glm::dot(slope, slope);
    if (square < 0.1) return start;
    return start + glm::clamp(-distance / square * slope, -0.4 * cell, 0.4 * cell);
}

}  // namespace

Shape make_surface(const Solid& solid, double cell) {
    const Lattice lattice(solid, cell);
    const glm::ivec3 size = lattice.size();
    Shape shape;
    // For each cell that the surface crosses: the vertex of each of its edges.
    std::vector<std::array<std::uint32_t, 12>> vertices;
    std::vector<std::uint32_t> cells(lattice.index({0, 0, size.z}), none);
    glm::ivec3 at;
    for (at.z = 0; at.z + 1 < size.z; ++at.z)
        for (at.y = 0; at.y + 1 < size.y; ++at.y)
            for (at.x = 0; at.x + 1 < size.x; ++at.x) {
                if (!lattice.is_crossed(at)) continue;
                cells[lattice.index(at)] = static_cast<std::uint32_t>(vertices.size());
                std::array<std::uint32_t, 12>& of_edges = vertices.emplace_back();
                std::array<std::uint32_t, 12> of_parts{};
                std::array<glm::dvec4, 12> sums{};
                const Crossings crossings(lattice, at);
                crossings.for_each([&](std::size_t, std::size_t part, const glm::dvec3& crossing) {
                    sums[part] += glm::dvec4(crossing, 1);
                });
                // A vertex starts in the middle of the crossings of its part.
                for (std::size_t part = 0; part < 12; ++part) {
                    if (sums[part].w == 0) continue;
                    of_parts[part] = static_cast<std::uint32_t>(shape.positions.size());
                    const glm::dvec3 middle =
                        lattice.position(glm::dvec3(sums[part]) / sums[part].w);
                    shape.positions.push_back(onto_surface(solid, middle, cell));
                }
                crossings.for_each([&](std::size_t edge, std::size_t part, const glm::dvec3&) {
                    of_edges[edge] = of_parts[part];
                });
            }

    // Around each edge that the surface crosses, four cells make a square.
    for (at.z = 1; at.z + 1 < size.z; ++at.z)
        for (at.y = 1; at.y + 1 < size.y; ++at.y)
            for (at.x = 1; at.x + 1 < size.x; ++at.x)
                for (int axis = 0; axis < 3; ++axis) {
                    glm::ivec3 next = at, u(0), v(0);
                    ++next[axis];
                    u[(axis + 1) % 3] = 1;
                    v[(axis + 2) % 3] = 1;
                    const bool starts_inside = lattice.value(at) < 0;
                    if (starts_inside == (lattice.value(next) < 0)) continue;
                    const auto vertex = [&](int i, int j) {
                        const std::uint32_t around = cells[lattice.index(at - i * u - j * v)];
                        return vertices[around][edge_of(axis, i, j)];
                    };
                    std::array<std::uint32_t, 4> q{vertex(1, 1), vertex(0, 1), vertex(0, 0),
                                                   vertex(1, 0)};
                    if (!starts_inside) std::swap(q[1], q[3]);
                    const auto length = [&](std::size_t a, std::size_t b) {
                        return glm::distance(shape.positions[q[a]], shape.positions[q[b]]);
                    };
                    // Along the shorter diagonal.
                    const std::size_t turn = length(0, 2) <= length(1, 3) ? 0 : 1;
                    const auto corner = [&](std::size_t k) { return q[(k + turn) % 4]; };
                    shape.triangles.emplace_back(corner(0), corner(1), corner(2));
                    shape.triangles.emplace_back(corner(0), corner(2), corner(3));
                }
    return shape;
}

}  // namespace motion
