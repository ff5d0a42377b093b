// SPDX-License-Identifier: MIT
#include "neighbour_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "particles_kernels.hpp"

namespace particles {
namespace {

/// The square of the distance, the short way round in a periodic box. The same operations as in
/// reference.cpp.
constexpr auto distance_squared =
    "fma(fmin(fabs(record.x - other.x), period - fabs(record.x - other.x)), "
    "fmin(fabs(record.x - other.x), period - fabs(record.x - other.x)), "
    "fma(fmin(fabs(record.y - other.y), period - fabs(record.y - other.y)), "
    "fmin(fabs(record.y - other.y), period - fabs(record.y - other.y)), "
    "fmin(fabs(record.z - other.z), period - fabs(record.z - other.z)) * "
    "fmin(fabs(record.z - other.z), period - fabs(record.z - other.z))))";

}  // namespace

Space make_space(const Scene& scene, int cells_per_radius) {
    Space space{};
    // Distances and places are rounded, by less than this part of the radius.
    const double reach = static_cast<double>(scene.radius) * (1 + 1e-5);
    double cells_per_unit = cells_per_radius / reach;
    if (scene.box == Box::periodic) {
        space.period = 1;
        // Few particles have large cells; beyond 1024 an axis would not fit into memory.
        cells_per_unit = std::clamp(std::floor(cells_per_unit), 1.0, 1024.0);
        space.extent = static_cast<std::uint64_t>(cells_per_unit);
    } else {
        // About as many lists as the unit box has cells. Any number is correct.
        space.period = std::numeric_limits<cl_float>::infinity();
        space.extent =
            static_cast<std::uint64_t>(std::clamp(std::ceil(cells_per_unit), 1.0, 1024.0));
    }
    space.cells_per_unit = static_cast<cl_float>(cells_per_unit);
    space.radius_cells = static_cast<std::uint32_t>(cells_per_radius);
    return space;
}

std::vector<Particle> numbered_points(const Scene& scene, std::size_t first, std::size_t end) {
    std::vector<Particle> points;
    points.reserve(end - first);
    for (std::size_t i = first; i < end; ++i) {
        const cl_float4& point = scene.points[i];
        points.push_back({point.s[0], point.s[1], point.s[2], static_cast<cl_uint>(i)});
    }
    return points;
}

cellist::Source kernel_source() {
    return {.text = std::string(kernels::particles_cl), .file_name = "particles.cl"};
}

// ---- NeighbourSums ---------------------------------------------------------------------------

NeighbourSums::NeighbourSums(const cellist::Device& device, const Space& space, cl_float radius)
    : device_(device),
      space_(space),
      radius_(radius),
      sums_(device, 0),
      sum_(device, kernel_source(), "sum_neighbours", cellist::type<Particle>) {}

void NeighbourSums::find(const cellist::Lists<Particle>& lists) {
    neighbours_ = lists.neighbours(&Particle::id,
                                   {.distance = distance_squared,
                                    .radius = radius_ * radius_,
                                    .radius_cells = space_.radius_cells,
                                    .values = {{"period", space_.period}}},
                                   std::move(neighbours_));
    if (sums_.size() < neighbours_.records)
        sums_ = cellist::Buffer<cl_uint2>(device_, neighbours_.records);
    const auto count = static_cast<cl_uint>(neighbours_.records);
    sum_.run(cellist::Range::padded(count, 64), neighbours_.offsets, neighbours_.indices, count,
             sums_);
}

std::vector<cl_uint2> NeighbourSums::download() const {
    return sums_.download(0, neighbours_.records);
}

// ---- NeighbourSearch -------------------------------------------------------------------------

NeighbourSearch::NeighbourSearch(const cellist::Device& device, const Scene& scene,
                                 cellist::Storage storage, int cells_per_radius)
    : space_(make_space(scene, cells_per_radius)),
      points_(device, numbered_points(scene, 0, scene.points.size())),
      lists_(device, space_.shape(), {.storage = storage, .periodic = {true, true, true}}),
      insert_(device, kernel_source(), "insert_particles", lists_),
      sums_(device, space_, scene.radius) {}

cellist::BuildReport NeighbourSearch::build() {
    const auto count = static_cast<cl_uint>(points_.size());
    return lists_.build(insert_, cellist::Range::padded(count), points_, count, space_.period,
                        space_.cells_per_unit);
}

std::vector<cl_uint2> NeighbourSearch::found() const {
    const std::vector<cl_uint> ids = lists_.pack(&Particle::id).records.download();
    const std::vector<cl_uint2> sums = sums_.download();
    std::vector<cl_uint2> found(points_.size(), {{0, 0}});
    for (std::size_t i = 0; i < ids.size(); ++i) found[ids[i]] = sums[i];
    return found;
}

}  // namespace particles
