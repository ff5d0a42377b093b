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

cellist::Source source() {
    return {.text = std::string(kernels::particles_cl), .file_name = "particles.cl"};
}

}  // namespace

NeighbourSearch::NeighbourSearch(const cellist::Device& device, const Scene& scene,
                                 cellist::Storage storage, int cells_per_radius)
    : space_(make_space(scene, cells_per_radius)),
      radius_(scene.radius),
      points_(device, scene.points),
      lists_(device, {space_.extent, space_.extent, space_.extent},
             {.storage = storage, .periodic = {true, true, true}}),
      found_(device, scene.points.size()),
      insert_(device, source(), "insert_particles", lists_),
      sum_(device, source(), "sum_neighbours", lists_) {}

cellist::BuildReport NeighbourSearch::build() {
    const auto count = static_cast<cl_uint>(points_.size());
    return lists_.build(insert_, cellist::Range::padded(count), points_, count, space_.period,
                        space_.cells_per_unit);
}

void NeighbourSearch::find() {
    neighbours_ = lists_.neighbours(&Particle::id,
                                    {.distance = distance_squared,
                                     .radius = radius_ * radius_,
                                     .radius_cells = space_.radius_cells,
                                     .values = {{"period", space_.period}}},
                                    std::move(neighbours_));
    const auto count = static_cast<cl_uint>(neighbours_.records);
    found_.fill({{0, 0}});
    sum_.run(cellist::Range::padded(count, 64), neighbours_.offsets, neighbours_.indices,
             lists_.pack(&Particle::id).records, count, found_);
}

}  // namespace particles
