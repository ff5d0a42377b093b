// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace support {

/// A k-d tree of points in a plane (Bentley 1975) that finds points in a triangle. Points can be
/// removed.
class PointTree {
public:
    using Triangle = std::array<glm::dvec2, 3>;

    /// Replaces the contents by these points, which are indices into `points`.
    void build(std::span<const glm::dvec2> points, std::vector<std::uint32_t> indices);
    void remove(std::uint32_t index);

    /// The index with the greatest `depth(index)` of at least 0 among the points in or near a
    /// counter-clockwise triangle; `none` where there is none. `depth` of a point in the triangle
    /// must return twice the area that the point spans with the edge from the third corner to the
    /// first, or
    /// -1 to skip the point. Adds its work to `steps`.
    template <class Depth>
    [[nodiscard]] std::uint32_t deepest(const Triangle& triangle, std::uint64_t& steps,
                                        const Depth& depth) const;

    static constexpr std::uint32_t none = 0xFFFFFFFF;

private:
    static constexpr std::uint32_t leaf_points = 8;

    struct Node {
        glm::dvec2 low, high;
        std::uint32_t begin = 0, end = 0;  // of indices_
        std::uint32_t left = none;         // the right child follows the left one; none for leaves
        std::uint32_t parent = none;
        std::uint32_t held = 0;  // points not removed
    };

    /// An upper bound of the depth of the points in the node's box; -1 where the box is outside the
    /// triangle.
    static double bound(const Node& node, const Triangle& triangle);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint32_t> leaf_of_;  // by index
};

inline double PointTree::bound(const Node& node, const Triangle& t) {
    const glm::dvec2 low = glm::min(glm::min(t[0], t[1]), t[2]);
    const glm::dvec2 high = glm::max(glm::max(t[0], t[1]), t[2]);
    if (node.high.x < low.x || node.low.x > high.x || node.high.y < low.y || node.low.y > high.y)
        return -1;
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2& a = t[k];
        const glm::dvec2 along = t[(k + 1) % 3] - a;
        // The corner of the box that lies farthest to the left of the edge.
        const glm::dvec2 corner{along.y > 0 ? node.low.x : node.high.x,
                                along.x > 0 ? node.high.y : node.low.y};
        most = along.x * (corner.y - a.y) - along.y * (corner.x - a.x);
        if (most < 0) return -1;
    }
    return most;
}

template <class Depth>
std::uint32_t PointTree::deepest(const Triangle& triangle, std::uint64_t& steps,
                                 const Depth& depth) const {
    std::array<std::uint32_t, 64> stack{};
    std::size_t height = 0;
    if (!nodes_.empty()) stack[height++] = 0;
    std::uint32_t found = none;
    double most = -1;
    while (height > 0) {
        const Node& node = nodes_[stack[--height]];
        ++steps;
        if (node.held == 0 || !(bound(node, triangle) > most)) continue;
        if (node.left != none) {
            stack[height++] = node.left;
            stack[height++] = node.left + 1;
            continue;
        }
        steps += node.end - node.begin;
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const double here = depth(indices_[i]);
            if (here <= most) continue;
            most = here;
            found = indices_[i];
        }
    }
    return found;
}

}  // namespace support
