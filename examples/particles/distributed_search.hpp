// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <cellist/mpi.hpp>

#include "neighbour_search.hpp"

namespace particles {

/// The search of NeighbourSearch over all ranks of MPI_COMM_WORLD. Each rank has the particles of a
/// block of cells, and copies of those next to it. All functions are collective, and block.
class DistributedSearch {
public:
    /// At first, each rank has an equal part of the points, wherever they are. Refers to the
    /// device, which must outlive it. Throws Error if there are too few cells for the ranks.
    DistributedSearch(const cellist::Device& device, const Scene& scene, cellist::Storage storage,
                      int cells_per_radius);

    /// Puts every particle into the list of its cell, on the rank of that cell. Returns the report
    /// of all ranks.
    cellist::BuildReport build();
    /// Makes later builds insert the particles where they are now: each rank inserts those that it
    /// has. Call it before exchange_ghosts().
    void keep_own_points() { points_ = lists_.local().pack().records; }
    /// Copies the particles next to each block into its ghost cells.
    void exchange_ghosts() { lists_.exchange_ghosts(); }
    /// Finds the neighbours of each rank's own particles.
    void find() { sums_.find(lists_.local()); }

    /// On the first rank, for each point of the scene, the number of its neighbours and the sum of
    /// their hashes. Empty on other ranks.
    [[nodiscard]] std::vector<cl_uint2> found() const;
    [[nodiscard]] const cellist::mpi::Lists<Particle>& lists() const { return lists_; }

private:
    Space space_;
    std::size_t scene_points_;
    cellist::mpi::Lists<Particle> lists_;
    cellist::Kernel insert_;
    cellist::Buffer<Particle> points_;  ///< of this rank
    NeighbourSums sums_;
};

}  // namespace particles
