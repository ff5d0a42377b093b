#include "queries.hpp"

#include "triangle_grid_kernels.hpp"

namespace triangle_grid {
namespace {

std::vector<cl_float4> ends_of(std::span<const Segment> segments) {
    std::vector<cl_float4> ends;
    ends.reserve(2 * segments.size());
    for (const Segment& segment : segments)
        for (const glm::vec3& end : {segment.from, segment.to})
            ends.push_back({{end.x, end.y, end.z, 0}});
    return ends;
}

}  // namespace

Queries::Queries(const cellist::Device& device, const grid::TriangleGrid& triangles,
                 std::span<const Segment> segments)
    : triangles_(triangles),
      ends_(device, ends_of(segments)),
      hits_(device, segments.size()),
      ask_(device,
           cellist::Source{.text = grid::with_queries(kernels::queries_cl),
                           .file_name = "queries.cl"},
           "ask", triangles.entries(), cellist::type<grid::GridCells>,
           cellist::type<grid::GridTriangle>) {}

void Queries::ask() {
    const auto count = static_cast<cl_uint>(hits_.size());
    ask_.run(cellist::Range::padded(count, 64), triangles_.entries(), triangles_.cells(),
             triangles_.triangles(), ends_, count, hits_);
}

}  // namespace triangle_grid
