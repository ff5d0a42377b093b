#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <cellist/cellist.hpp>

#include "grid/triangle_grid.hpp"
#include "segments.hpp"

namespace triangle_grid {

/// Asks a grid whether segments meet any of its triangles.
class Queries {
public:
    /// Uploads the segments and builds the kernel. The grid must outlive this.
    Queries(const cellist::Device& device, const grid::TriangleGrid& triangles,
            std::span<const Segment> segments);

    /// Does not block.
    void ask();
    /// 1 for each segment that meets a triangle, 0 for the others. Blocks.
    [[nodiscard]] std::vector<cl_uint> hits() const { return hits_.download(); }

private:
    const grid::TriangleGrid& triangles_;
    cellist::Buffer<cl_float4> ends_;
    cellist::Buffer<cl_uint> hits_;
    cellist::Kernel ask_;
};

}  // namespace triangle_grid
