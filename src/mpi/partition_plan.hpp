// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <cellist/mpi.hpp>

#include "device/view.hpp"
#include "mpi/communicator.hpp"

namespace cellist::detail {

using Position = std::array<std::uint64_t, 4>;

/// A box of this rank's cells, which another rank has as ghost cells; beyond a periodic border,
/// this rank may be that rank.
struct GhostCopy {
    int rank;        ///< the rank that has the ghost cells
    Position first;  ///< the first cell of the box, in this rank's lists
    Position extent;
    Position target;  ///< the first cell of the box, in the lists of `rank`
};

class PartitionPlan {
public:
    /// Divides the cells by `weights`, or by `options` if `weights` is null. Collective. Throws
    /// what the constructors of mpi::Partition throw.
    PartitionPlan(MPI_Comm comm, const Shape& shape, const mpi::PartitionOptions& options,
                  const std::vector<std::uint64_t>* weights);

    [[nodiscard]] const Communicator& communicator() const { return communicator_; }
    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] const mpi::PartitionOptions& options() const { return options_; }
    [[nodiscard]] const mpi::Block& block(int rank) const;
    [[nodiscard]] const mpi::Block& own() const { return block(communicator_.rank()); }

    [[nodiscard]] Position position(std::uint64_t cell) const;
    [[nodiscard]] std::uint64_t cell(const Position& position) const;
    [[nodiscard]] int owner(const Position& position) const;

    /// The layers of ghost cells along each axis: 0 along axes that are not divided.
    [[nodiscard]] const Position& ghosts() const { return ghosts_; }
    /// The extents of a rank's lists: its block with the ghost cells, or 0 for an empty block.
    [[nodiscard]] Position held(int rank) const;
    [[nodiscard]] std::vector<GhostCopy> ghost_copies() const;
    /// The distribution as kernels get it, but without an outbox.
    [[nodiscard]] cellist_distribution distribution() const;

    /// The tree of cuts: an axis, a position, and the parts before and from the position on. A
    /// part is the index of a cut, or -1 - r for the block of rank r. The root is the first cut.
    /// There are no cuts if there is one rank.
    [[nodiscard]] const std::vector<std::array<cl_int, 4>>& cuts() const { return cuts_; }

private:
    using Weights = std::vector<std::uint64_t>;
    cl_int cut_into_grid(const std::array<std::uint32_t, 4>& first,
                         const std::array<std::uint32_t, 4>& end);
    [[nodiscard]] std::size_t axis_to_cut(const mpi::Block& block, std::uint64_t width) const;
    cl_int cut_in_two(const mpi::Block& block, int first_rank, int ranks, const Weights* weights);
    [[nodiscard]] std::vector<std::uint64_t> layer_weights(const mpi::Block& block,
                                                           std::size_t axis,
                                                           const Weights& weights) const;
    cl_int add_cut(std::size_t axis, std::uint64_t position);
    void choose_ghosts();

    Communicator communicator_;
    Shape shape_;
    mpi::PartitionOptions options_;
    std::vector<mpi::Block> blocks_;
    std::vector<std::array<cl_int, 4>> cuts_;
    Position ghosts_{};
};

/// Returns a shape with the first `dimensions` of the extents.
[[nodiscard]] Shape shape_of(const Position& extent, std::size_t dimensions);

}  // namespace cellist::detail
