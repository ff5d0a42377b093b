// SPDX-License-Identifier: MIT
#include "distributed_search.hpp"

#include <numeric>

namespace particles {
namespace {

// What a rank sends of one particle.
struct Found {
    cl_uint id, neighbours, sum;
};

cellist::mpi::Partition make_partition(const Space& space) {
    return {MPI_COMM_WORLD,
            space.shape(),
            {.ghosts = space.radius_cells, .periodic = {true, true, true}}};
}

std::vector<Particle> part_of(const Scene& scene, const cellist::mpi::Partition& partition) {
    const std::size_t points = scene.points.size();
    const auto ranks = static_cast<std::size_t>(partition.ranks());
    const auto rank = static_cast<std::size_t>(partition.rank());
    return numbered_points(scene, points * rank / ranks, points * (rank + 1) / ranks);
}

// The elements of all ranks, on the first.
std::vector<Found> gathered(const std::vector<Found>& mine, int rank, int ranks) {
    const auto count = static_cast<int>(mine.size());
    std::vector<int> counts(static_cast<std::size_t>(ranks)), offsets(counts.size());
    MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
    std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
    const int sum = offsets.back() + counts.back();
    std::vector<Found> all(rank == 0 ? static_cast<std::size_t>(sum) : 0);
    MPI_Datatype type = MPI_DATATYPE_NULL;
    MPI_Type_contiguous(3, MPI_UINT32_T, &type);
    MPI_Type_commit(&type);
    MPI_Gatherv(mine.data(), count, type, all.data(), counts.data(), offsets.data(), type, 0,
                MPI_COMM_WORLD);
    MPI_Type_free(&type);
    return all;
}

}  // namespace

DistributedSearch::DistributedSearch(const cellist::Device& device, const Scene& scene,
                                     cellist::Storage storage, int cells_per_radius)
    : space_(make_space(scene, cells_per_radius)),
      scene_points_(scene.points.size()),
      lists_(device, make_partition(space_), {.storage = storage}),
      insert_(device, kernel_source(), "insert_particles", lists_),
      points_(device, part_of(scene, lists_.partition())),
      sums_(device, space_, scene.radius) {}

cellist::BuildReport DistributedSearch::build() {
    const auto count = static_cast<cl_uint>(points_.size());
    return lists_.build(insert_, cellist::Range::padded(count), points_, count, space_.period,
                        space_.cells_per_unit);
}

std::vector<cl_uint2> DistributedSearch::found() const {
    const auto packed = lists_.local().pack(&Particle::id);
    const std::vector<cl_uint> ids = packed.records.download();
    const std::vector<cl_uint> offsets = packed.offsets.download();
    const std::vector<cl_uint2> sums = sums_.download();
    const cellist::mpi::Partition& partition = lists_.partition();
    std::vector<Found> own;
    for (std::uint64_t cell = 0; cell + 1 < offsets.size(); ++cell)
        if (partition.cell(cell))
            for (cl_uint i = offsets[cell]; i < offsets[cell + 1]; ++i)
                own.push_back({ids[i], sums[i].s[0], sums[i].s[1]});

    std::vector<cl_uint2> found(partition.rank() == 0 ? scene_points_ : 0, {{0, 0}});
    for (const Found& one : gathered(own, partition.rank(), partition.ranks()))
        found[one.id] = {{one.neighbours, one.sum}};
    return found;
}

}  // namespace particles
