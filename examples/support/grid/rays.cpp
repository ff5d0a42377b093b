// SPDX-License-Identifier: MIT
#include "grid/rays.hpp"

#include <algorithm>
#include <string>

#include "grid_kernels.hpp"

namespace grid {
namespace {

cellist::Kernel kernel(const cellist::Device& device, const TriangleGrid& triangles,
                       const char* name) {
    return {device,
            cellist::Source{.text = with_queries(kernels::rays_cl), .file_name = "rays.cl"},
            name,
            triangles.entries(),
            cellist::type<GridCells>,
            cellist::type<GridTriangle>,
            cellist::type<GridHit>,
            cellist::type<GridRayCounters>};
}

/// Kernels number the ends of segments in 32 bits.
constexpr std::size_t segments_max = 0x7FFFFFFF;

}  // namespace

Rays::Rays(const cellist::Device& device, const TriangleGrid& triangles)
    : device_(device),
      triangles_(triangles),
      range_(whole_device(device.info())),
      counters_(device, 1),
      undecided_(device, 0),
      any_(kernel(device, triangles, "grid_any_hits")),
      any_exactly_(kernel(device, triangles, "grid_any_hits_exactly")),
      closest_(kernel(device, triangles, "grid_closest_hits")),
      closest_exactly_(kernel(device, triangles, "grid_closest_hits_exactly")),
      measure_(kernel(device, triangles, "grid_measure_hits")) {}

template <class Result>
void Rays::trace(cellist::Kernel& quickly, cellist::Kernel& exactly,
                 const cellist::Buffer<GridSegment>& segments, std::size_t count,
                 cellist::Buffer<Result>& results) {
    for (const std::size_t size : {segments.size(), results.size()})
        if (size < count)
            throw cellist::Error("a buffer of " + std::to_string(size) +
                                 " elements is too short for " + std::to_string(count) +
                                 " segments");
    if (count > segments_max)
        throw cellist::Error(std::to_string(count) + " segments: trace at most " +
                             std::to_string(segments_max) + " at once");
    if (undecided_.size() < count) undecided_ = cellist::Buffer<cl_uint>(device_, count);
    counters_.fill({});
    triangles_.run(quickly, range_, segments.cl(), static_cast<cl_uint>(count), results, counters_,
                   undecided_);
    triangles_.run(exactly, range_, segments.cl(), results, counters_, undecided_);
}

void Rays::any_hits(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                    cellist::Buffer<cl_uint>& any) {
    trace(any_, any_exactly_, segments, count, any);
}

void Rays::closest_hits(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                        cellist::Buffer<GridHit>& closest) {
    trace(closest_, closest_exactly_, segments, count, closest);
    triangles_.run(measure_, cellist::Range::padded(count, 64), segments.cl(),
                   static_cast<cl_uint>(count), closest);
}

}  // namespace grid
