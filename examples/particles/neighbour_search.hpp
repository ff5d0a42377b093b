// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
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

    [[nodiscard]] cellist::Shape shape() const { return {extent, extent, extent}; }
};

/// `cells_per_radius` is the number of cells along the radius: with more, fewer particles are
/// looked at, and more lists.
[[nodiscard]] Space make_space(const Scene& scene, int cells_per_radius);

/// The points of a scene from `first` to `end` - 1, with their numbers.
[[nodiscard]] std::vector<Particle> numbered_points(const Scene& scene, std::size_t first,
                                                    std::size_t end);

/// The kernels of particles.cl.
[[nodiscard]] cellist::Source kernel_source();

/// Finds the neighbours of the particles in lists.
class NeighbourSums {
public:
    /// Refers to the device, which must outlive it.
    NeighbourSums(const cellist::Device& device, const Space& space, cl_float radius);

    /// Blocks until the number of neighbours is known.
    void find(const cellist::Lists<Particle>& lists);

    /// For each particle of the last search, in the order of Lists::pack(), the number of its
    /// neighbours and the sum of their hashes. Blocks.
    [[nodiscard]] std::vector<cl_uint2> download() const;

private:
    const cellist::Device& device_;
    Space space_;
    cl_float radius_;
    cellist::Neighbours neighbours_;
    cellist::Buffer<cl_uint2> sums_;
    cellist::Kernel sum_;
};

/// Finds the neighbours of every point of a scene.
class NeighbourSearch {
public:
    /// Uploads the points, builds the kernels and allocates. Refers to the device, which must
    /// outlive it.
    NeighbourSearch(const cellist::Device& device, const Scene& scene, cellist::Storage storage,
                    int cells_per_radius);

    /// Puts every particle into the list of its cell. Blocks.
    cellist::BuildReport build();
    /// Finds all neighbours. Blocks until their number is known.
    void find() { sums_.find(lists_); }

    /// For each point, the number of its neighbours and the sum of their hashes. Blocks.
    [[nodiscard]] std::vector<cl_uint2> found() const;
    [[nodiscard]] const cellist::Lists<Particle>& lists() const { return lists_; }

private:
    Space space_;
    cellist::Buffer<Particle> points_;
    cellist::Lists<Particle> lists_;
    cellist::Kernel insert_;
    NeighbourSums sums_;
};

}  // namespace particles
