#include "surface_nets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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
    [[nodiscard]] glm::dvec3 position(const glm::dvec3& at) const { return origin_ + cell_ * at; }

private:
    static constexpr int side = 8;  // of a block

    // Far from the surface, one distance does for a whole block.
    void fill(const glm::ivec3& first) {
        const glm::ivec3 end = glm::min(first + side, size_);
        const double centre = solid_.distance(position(glm::dvec3(first) + 0.5 * (side - 1)));
        const bool is_far = std::abs(centre) > 0.87 * side * cell_ + solid_.slack;
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

// The corners of a cell of side 1: bits of `k` are its coordinates.
glm::dvec3 corner_offset(std::size_t k) { return {k & 1, (k >> 1) & 1, k >> 2}; }

// Two steps of Newton's method from a point near the surface.
glm::dvec3 onto_surface(const Solid& solid, const glm::dvec3& start, double cell) {
    const double step = 0.1 * cell;
    glm::dvec3 p = start;
    for (int round = 0; round < 2; ++round) {
        glm::dvec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 before = p, after = p;
            before[axis] -= step;
            after[axis] += step;
            slope[axis] = (solid.distance(after) - solid.distance(before)) / (2 * step);
        }
        const double square = glm::dot(slope, slope);
        if (square > 0.1) p -= solid.distance(p) * slope / square;
    }
    return glm::clamp(p, start - 0.4 * cell, start + 0.4 * cell);
}

}  // namespace

Shape make_surface(const Solid& solid, double cell) {
    const Lattice lattice(solid, cell);
    const glm::ivec3 size = lattice.size();
    Shape shape;
    std::vector<std::uint32_t> vertices(lattice.index({0, 0, size.z}), none);
    glm::ivec3 at;
    for (at.z = 0; at.z + 1 < size.z; ++at.z)
        for (at.y = 0; at.y + 1 < size.y; ++at.y)
            for (at.x = 0; at.x + 1 < size.x; ++at.x) {
                std::array<float, 8> corners{};
                int inside = 0;
                for (std::size_t k = 0; k < 8; ++k) {
                    corners[k] = lattice.value(at + glm::ivec3(corner_offset(k)));
                    inside += corners[k] < 0 ? 1 : 0;
                }
                if (inside == 0 || inside == 8) continue;
                // The mean of the points where the surface crosses the cell's edges.
                glm::dvec3 sum(0);
                int crossings = 0;
                for (std::size_t k = 0; k < 8; ++k)
                    for (int axis = 0; axis < 3; ++axis) {
                        const std::size_t other = k | (std::size_t{1} << axis);
                        if (other == k || (corners[k] < 0) == (corners[other] < 0)) continue;
                        glm::dvec3 crossing = corner_offset(k);
                        crossing[axis] = corners[k] / (corners[k] - corners[other]);
                        sum += crossing;
                        ++crossings;
                    }
                vertices[lattice.index(at)] = static_cast<std::uint32_t>(shape.positions.size());
                const glm::dvec3 mean = lattice.position(glm::dvec3(at) + sum / double(crossings));
                shape.positions.push_back(onto_surface(solid, mean, cell));
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
                    std::array<std::uint32_t, 4> q{
                        vertices[lattice.index(at - u - v)], vertices[lattice.index(at - v)],
                        vertices[lattice.index(at)], vertices[lattice.index(at - u)]};
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
