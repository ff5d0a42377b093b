// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <cellist/cellist.hpp>

#include "grid/triangle_grid.hpp"

namespace grid {

/// The ends of a segment; w is unused.
struct GridSegment {
    cl_float4 from, to;
};
CELLIST_STRUCT(GridSegment, from, to);

/// What a segment meets first.
struct GridHit {
    static constexpr cl_uint none = 0xFFFFFFFF;
    cl_uint triangle;  ///< or none
    cl_float at;       ///< how far along the segment, 0 to 1; infinite if there is none
    cl_float u, v;     ///< the weights of corners b and c
};
CELLIST_STRUCT(GridHit, triangle, at, u, v);

struct GridRayCounters {
    cl_uint next;       ///< segment
    cl_uint undecided;  ///< segments that float cannot decide
    cl_uint invalid;    ///< segments with an end that is not finite
};
CELLIST_STRUCT(GridRayCounters, next, undecided, invalid);

/// Traces many segments through a grid. Answers are those of testing every triangle exactly:
/// segments do not pass between triangles that share an edge or a corner. A segment meets a
/// triangle that it touches. It does not meet one in whose plane it lies, nor one without area. A
/// segment without length meets nothing.
class Rays {
public:
    /// Builds the kernels. The device and the grid must outlive this.
    Rays(const cellist::Device& device, const TriangleGrid& triangles);

    /// Writes to `any` whether each of the first `count` segments meets a triangle: 1 or 0. Throws
    /// Error if a buffer is too short or `count` exceeds 2^31 - 1. Does not block.
    void any_hits(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                  cellist::Buffer<cl_uint>& any);
    /// Writes what each segment meets first. Triangles are compared by distances that are off by at
    /// most 2^-12 of the segment where it nearly touches their planes, and by a few roundings
    /// elsewhere; among equal ones, the lowest number is first. Otherwise as any_hits().
    void closest_hits(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                      cellist::Buffer<GridHit>& closest);

    /// Segments of the last call with an end that is not finite; they meet nothing. Blocks.
    [[nodiscard]] std::uint32_t invalid() const { return counters_.download()[0].invalid; }

    [[nodiscard]] std::uint64_t device_bytes() const {
        return counters_.size() * sizeof(GridRayCounters) + undecided_.size() * sizeof(cl_uint);
    }

private:
    template <class Result>
    void trace(cellist::Kernel& quickly, cellist::Kernel& exactly,
               const cellist::Buffer<GridSegment>& segments, std::size_t count,
               cellist::Buffer<Result>& results);

    const cellist::Device& device_;
    const TriangleGrid& triangles_;
    cellist::Range range_;
    cellist::Buffer<GridRayCounters> counters_;
    cellist::Buffer<cl_uint> undecided_;
    cellist::Kernel any_;
    cellist::Kernel any_exactly_;
    cellist::Kernel closest_;
    cellist::Kernel closest_exactly_;
    cellist::Kernel measure_;
};

}  // namespace grid
