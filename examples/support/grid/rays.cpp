#include "grid/rays.hpp"

#include <algorithm>
#include <string>

#include "grid_kernels.hpp"

namespace grid {
namespace {

/// Tests that the second kernel does. Where there are more, it does whole searches.
constexpr std::size_t tests_max = std::size_t{1} << 18;

cellist::Kernel kernel(const cellist::Device& device, const TriangleGrid& triangles,
                       const char* name) {
    return {device,
            cellist::Source{.text = with_queries(kernels::rays_cl), .file_name = "rays.cl"},
            name,
            triangles.entries(),
            cellist::type<GridCells>,
            cellist::type<GridTriangle>,
            cellist::type<GridHit>};
}

/// As many work-items as a device runs at once: each takes segments until there are none left.
cellist::Range whole_device(const cellist::DeviceInfo& device) {
    const std::size_t group = device.one_thread_per_work_group ? 1 : 64;
    const std::size_t groups =
        std::size_t{device.compute_units} * (device.one_thread_per_work_group ? 1 : 16);
    return cellist::Range::padded(groups * group, group);
}

}  // namespace

Rays::Rays(const cellist::Device& device, const TriangleGrid& triangles)
    : device_(device),
      triangles_(triangles),
      range_(whole_device(device.info())),
      counters_(device, GRID_COUNTERS),
      searches_(device, 0),
      tests_(device, tests_max),
      any_(kernel(device, triangles, "grid_any_hits")),
      any_exactly_(kernel(device, triangles, "grid_any_hits_exactly")),
      closest_(kernel(device, triangles, "grid_closest_hits")),
      closest_exactly_(kernel(device, triangles, "grid_closest_hits_exactly")) {}

void Rays::begin(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                 std::size_t results) {
    for (const std::size_t size : {segments.size(), results})
        if (size < count)
            throw cellist::Error("a buffer of " + std::to_string(size) +
                                 " elements is too short for " + std::to_string(count) +
                                 " segments");
    if (searches_.size() < count) searches_ = cellist::Buffer<cl_uint>(device_, count);
    counters_.fill(0);
}

void Rays::any_hits(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                    cellist::Buffer<cl_uint>& any) {
    begin(segments, count, any.size());
    const auto room = static_cast<cl_uint>(tests_.size());
    triangles_.run(any_, range_, segments.cl(), static_cast<cl_uint>(count), any, counters_,
                   searches_, tests_, room);
    triangles_.run(any_exactly_, range_, segments.cl(), any, counters_, searches_, tests_, room);
}

void Rays::closest_hits(const cellist::Buffer<GridSegment>& segments, std::size_t count,
                        cellist::Buffer<GridHit>& closest) {
    begin(segments, count, closest.size());
    triangles_.run(closest_, range_, segments.cl(), static_cast<cl_uint>(count), closest, counters_,
                   searches_);
    triangles_.run(closest_exactly_, range_, segments.cl(), closest, counters_, searches_);
}

}  // namespace grid
