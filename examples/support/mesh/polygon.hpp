// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "point_tree.hpp"

namespace support {

/// Splits polygons into triangles. Clips a convex corner if no other corner lies in its triangle.
/// Else cuts the polygon in two along the diagonal from that corner to the deepest corner in the
/// triangle (Meisters 1975). Signed areas decide, in the coordinate plane that is nearest to the
/// polygon's. Only reflex corners can be the deepest; a tree finds them. Each search gives a
/// triangle or a diagonal, so the number of searches is linear.
class PolygonSplitter {
public:
    enum class Result {
        split,
        flat,      ///< the polygon has no area
        crossing,  ///< the polygon crosses itself: it has no inside
        too_long   ///< the work that all polygons of this splitter may take is used up
    };
    using Triangle = std::array<std::uint32_t, 3>;

    /// Appends triangles whose corners are indices into `corners`, with the polygon's winding.
    /// Their projected areas add up to the area of the polygon. Leaves out equal neighbours and
    /// spikes without area. The polygon may touch itself. Appends nothing if the polygon cannot be
    /// split. There must be at least three corners, all finite.
    Result split(std::span<const glm::vec3> corners, std::vector<Triangle>& triangles);

private:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    // A place on the boundary. After cuts, several nodes may be at one corner.
    struct Node {
        std::uint32_t corner;  // of ring_ and points_
        std::uint32_t previous, next;
        std::uint32_t same;  // the next node at this corner
        bool clipped = false, reflex = false;
    };

    bool make_ring(std::span<const glm::vec3> corners);
    bool project(std::span<const glm::vec3> corners);
    void make_nodes();
    [[nodiscard]] bool turns_once() const;
    void clip_and_cut(std::vector<Triangle>& triangles);
    void clip(std::uint32_t ear, std::vector<Triangle>& triangles);
    void cut(std::uint32_t ear, std::uint32_t deepest);
    void exchange(std::uint32_t a, std::uint32_t b);
    std::uint32_t add_node(std::uint32_t corner, std::uint32_t previous, std::uint32_t next);
    void update(std::uint32_t node);
    [[nodiscard]] const glm::dvec2& place(std::uint32_t node) const {
        return points_[nodes_[node].corner];
    }
    [[nodiscard]] double turn_at(std::uint32_t node) const;
    [[nodiscard]] std::uint32_t deepest_in(std::uint32_t ear);
    [[nodiscard]] std::uint32_t node_facing(std::uint32_t corner, std::uint32_t ear,
                                            std::uint64_t& steps) const;

    // The corners that count, and their places in the plane.
    std::vector<std::uint32_t> ring_;
    std::vector<glm::dvec2> points_;
    double area_ = 0, clipped_area_ = 0;  // twice these

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> reflex_nodes_;  // number of each corner
    PointTree reflex_corners_;
    std::vector<std::uint32_t> queue_;       // nodes to look at
    std::uint64_t work_left_ = 100'000'000;  // nodes and corners of the tree
};

}  // namespace support
