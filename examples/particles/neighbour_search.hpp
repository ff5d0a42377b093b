// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <cellist/cellist.hpp>

#include "scene.hpp"

namespace particles {

struct Particle {
    cl_float x, y, z;
    cl_uint id;
};
CELLIST_STRUCT(Particle, x, y, z, id);

/// The cells, and who is a neighbour.
struct Space {
    cl_float period;             ///< side of the periodic box, infinite in open space
    cl_float cells_per_unit;     ///< along each axis
    std::uint64_t extent;        ///< lists along each axis
    std::uint32_t radius_cells;  ///< cells along the radius
};

/// Finds the neighbours of every point of a scene.
class NeighbourSearch {
public:
    /// Uploads the points, builds the kernels and allocates. `cells_per_radius` is the number of
    /// cells along the radius: with more, fewer particles are looked at, and more lists.
    NeighbourSearch(const cellist::Device& device, const Scene& scene, cellist::Storage storage,
                    int cells_per_radius);

    /// Puts every particle into the list of its cell. Blocks.
    cellist::BuildReport build();
    /// Finds all neighbours. Blocks until their number is known.
    void find();

    /// For each point, the number of its neighbours and the sum of their hashes. Blocks.
    [[nodiscard]] std::vector<cl_uint2> found() const { return found_.download(); }
    [[nodiscard]] const cellist::Lists<Particle>& lists() const { return lists_; }

private:
    Space space_;
    cl_float radius_;
    cellist::Buffer<cl_float4> points_;
    cellist::Lists<Particle> lists_;
    cellist::Neighbours neighbours_;
    cellist::Buffer<cl_uint2> found_;
    cellist::Kernel insert_;
    cellist::Kernel sum_;
};

}  // namespace particles
