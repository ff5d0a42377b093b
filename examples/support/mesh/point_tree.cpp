// SPDX-License-Identifier: MIT
#include "point_tree.hpp"

#include <algorithm>
#include <utility>

namespace support {

void PointTree::build(std::span<const glm::dvec2> points, std::vector<std::uint32_t> indices) {
    indices_ = std::move(indices);
    leaf_of_.assign(points.size(), none);
    nodes_.clear();
    if (indices_.empty()) return;
    const auto add = [&](std::uint32_t begin, std::uint32_t end, std::uint32_t parent) {
        Node node{points[indices_[begin]],
                  points[indices_[begin]],
                  begin,
                  end,
                  none,
                  parent,
                  end - begin};
        for (std::uint32_t i = begin; i < end; ++i) {
            node.low = glm::min(node.low, points[indices_[i]]);
            node.high = glm::max(node.high, points[indices_[i]]);
        }
        nodes_.push_back(node);
    };
    add(0, static_cast<std::uint32_t>(indices_.size()), none);
    // Halves of equal size: the depth is the logarithm of the number of points.
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
        const Node node = nodes_[n];
        if (node.end - node.begin <= leaf_points) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) leaf_of_[indices_[i]] = n;
            continue;
        }
        const int axis = node.high.x - node.low.x > node.high.y - node.low.y ? 0 : 1;
        const std::uint32_t middle = node.begin + (node.end - node.begin) / 2;
        const auto first = indices_.begin();
        std::nth_element(
            first + node.begin, first + middle, first + node.end,
            [&](std::uint32_t a, std::uint32_t b) { return points[a][axis] < points[b][axis]; });
        nodes_[n].left = static_cast<std::uint32_t>(nodes_.size());
        add(node.begin, middle, n);
        add(middle, node.end, n);
    }
}

void PointTree::remove(std::uint32_t index) {
    for (std::uint32_t n = leaf_of_[index]; n != none; n = nodes_[n].parent) --nodes_[n].held;
    leaf_of_[index] = none;
}

}  // namespace support
