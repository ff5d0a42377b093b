#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "point_tree.hpp"

namespace support {

/// Splits polygons into triangles by ear clipping (Meisters 1975). Signed areas decide, in the
/// coordinate plane that the polygon's normal is nearest to. Only reflex corners can lie in an ear;
/// a tree finds them. A corner that is no ear waits for the corner that lies in it, so that few
/// corners are looked at twice.
class PolygonSplitter {
public:
    enum class Result {
        split,
        flat,      ///< the polygon has no area
        crossing,  ///< the polygon crosses itself: it has no inside
        too_long   ///< the work that all polygons of this splitter may take is used up
    };
    using Triangle = std::array<std::uint32_t, 3>;

    /// Appends triangles whose corners are indices into `corners`, with the polygon's winding. Their
    /// areas, seen along the normal, add up to the polygon's. Equal neighbours and spikes without
    /// area are left out; the polygon may touch itself. Appends nothing where it does not split.
    /// Corners have to be finite; there are three at least.
    Result split(std::span<const glm::vec3> corners, std::vector<Triangle>& triangles);

private:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    bool make_ring(std::span<const glm::vec3> corners);
    bool project(std::span<const glm::vec3> corners);
    [[nodiscard]] bool turns_once() const;
    bool clip_ears(bool touching_blocks, std::vector<Triangle>& triangles);
    void clip(std::uint32_t ear, std::vector<Triangle>& triangles);
    void wake(std::uint32_t corner);
    [[nodiscard]] double turn_at(std::uint32_t corner) const;
    [[nodiscard]] double area_left() const;
    [[nodiscard]] std::uint32_t blocker_of(std::uint32_t ear, bool touching_blocks);
    [[nodiscard]] bool blocks(std::uint32_t corner, std::uint32_t ear, bool touching_blocks) const;

    // The corners that are left, as a ring: index into the polygon, place in the plane, neighbours.
    std::vector<std::uint32_t> ring_;
    std::vector<glm::dvec2> points_;
    std::vector<std::uint32_t> previous_, next_;
    std::vector<bool> clipped_, reflex_;
    std::uint32_t left_ = 0;
    double area_ = 0;

    PointTree reflex_corners_;

    // Corners to look at, and for each corner a list of those that wait for it.
    struct Waiting {
        std::uint32_t corner, next;
    };
    std::vector<std::uint32_t> queue_;
    std::vector<std::uint32_t> first_waiting_;
    std::vector<Waiting> waiting_;
    std::uint64_t work_left_ = 100'000'000;  // nodes and corners of the tree
};

}  // namespace support
