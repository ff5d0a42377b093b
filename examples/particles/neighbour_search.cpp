#include "neighbour_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles_kernels.hpp"

namespace particles {
namespace {

Space make_space(const Scene& scene, int cells_per_radius) {
    Space space{};
    space.radius = scene.radius;
    const auto radius = static_cast<double>(scene.radius);
    double cells_per_unit = cells_per_radius / radius;
    if (scene.box == Box::periodic) {
        space.period = 1;
        // Few particles have large cells; beyond 1024 an axis would not fit into memory.
        cells_per_unit = std::clamp(std::floor(cells_per_unit), 1.0, 1024.0);
        space.extent = static_cast<cl_int>(cells_per_unit);
    } else {
        // About as many lists as the unit box has cells. Any number is correct.
        space.period = std::numeric_limits<cl_float>::infinity();
        space.extent = static_cast<cl_int>(std::clamp(std::ceil(cells_per_unit), 1.0, 1024.0));
    }
    space.cells_per_unit = static_cast<cl_float>(cells_per_unit);
    // Distances and their squares are rounded as well, by less than a millionth of the radius.
    space.reach = static_cast<cl_float>(radius * cells_per_unit * (1 + 4e-6));
    return space;
}

cellist::Source source() {
    return {.text = std::string(kernels::particles_cl), .file_name = "particles.cl"};
}

cellist::Shape shape_of(const Space& space) {
    const auto extent = static_cast<std::uint64_t>(space.extent);
    return {extent, extent, extent};
}

}  // namespace

NeighbourSearch::NeighbourSearch(const cellist::Device& device, const Scene& scene,
                                 cellist::Storage storage, int cells_per_radius)
    : space_(make_space(scene, cells_per_radius)),
      points_(device, scene.points),
      lists_(device, shape_of(space_), {.storage = storage}),
      sorted_{{device, 0}, {device, 0}},
      found_(device, scene.points.size()),
      insert_(device, source(), "insert_particles", lists_, cellist::type<Space>),
      find_(device, source(), "find_neighbours", lists_, cellist::type<Space>) {}

cellist::BuildReport NeighbourSearch::build() {
    const auto count = static_cast<cl_uint>(points_.size());
    const cellist::BuildReport report =
        lists_.build(insert_, cellist::Range::padded(count), points_, count, space_);
    sorted_ = lists_.pack();
    return report;
}

void NeighbourSearch::find() {
    const auto count = static_cast<cl_uint>(sorted_.records.size());
    found_.fill({{0, 0}});
    find_.run(cellist::Range::padded(count, 64), sorted_.offsets, sorted_.records, count, space_,
              found_);
}

}  // namespace particles
