#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace support {

/// Points in a plane, found by triangle: a k-d tree (Bentley 1975) from which points can be taken.
class PointTree {
public:
    using Triangle = std::array<glm::dvec2, 3>;

    /// Holds these points from now on: indices into `points`.
    void build(std::span<const glm::dvec2> points, std::vector<std::uint32_t> indices);
    void remove(std::uint32_t index);

    /// The first index for which `wanted(index)` holds, among those in or near a counter-clockwise
    /// triangle; `none` where there is no such point. Counts in `steps` what it looked at.
    template <class Wanted>
    [[nodiscard]] std::uint32_t find(const Triangle& triangle, std::uint64_t& steps,
                                     const Wanted& wanted) const;

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

    static bool misses(const Node& node, const Triangle& triangle);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint32_t> leaf_of_;  // by index
};

// Whether the box lies on the outer side of one of the triangle's edges, or beside its box.
inline bool PointTree::misses(const Node& node, const Triangle& t) {
    const glm::dvec2 low = glm::min(glm::min(t[0], t[1]), t[2]);
    const glm::dvec2 high = glm::max(glm::max(t[0], t[1]), t[2]);
    if (node.high.x < low.x || node.low.x > high.x || node.high.y < low.y || node.low.y > high.y)
        return true;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2& a = t[k];
        const glm::dvec2 along = t[(k + 1) % 3] - a;
        // The corner of the box that lies farthest to the left of the edge.
        const glm::dvec2 corner{along.y > 0 ? node.low.x : node.high.x,
                                along.x > 0 ? node.high.y : node.low.y};
        if (along.x * (corner.y - a.y) - along.y * (corner.x - a.x) < 0) return true;
    }
    return false;
}

template <class Wanted>
std::uint32_t PointTree::find(const Triangle& triangle, std::uint64_t& steps,
                              const Wanted& wanted) const {
    std::array<std::uint32_t, 64> stack{};
    std::size_t depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        ++steps;
        if (node.held == 0 || misses(node, triangle)) continue;
        if (node.left != none) {
            stack[depth++] = node.left;
            stack[depth++] = node.left + 1;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (wanted(indices_[i])) return indices_[i];
        steps += node.end - node.begin;
    }
    return none;
}

}  // namespace support
