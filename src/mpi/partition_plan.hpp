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

/// Cells of this rank that another rank, or this one beyond a periodic border, has as ghost cells.
struct GhostCopy {
    int rank;        ///< that has the ghost cells
    Position first;  ///< in this rank's lists
    Position extent;
    Position target;  ///< in the lists of `rank`
};

class PartitionPlan {
public:
    /// Blocks by `options`; by weights if there are some. Collective.
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

    /// Layers of ghost cells: 0 along axes that are not divided.
    [[nodiscard]] const Position& ghosts() const { return ghosts_; }
    /// Extents of a rank's lists.
    [[nodiscard]] Position held(int rank) const;
    [[nodiscard]] std::vector<GhostCopy> ghost_copies() const;
    /// As kernels see it, without an outbox.
    [[nodiscard]] cellist_distribution distribution() const;

    /// The tree of cuts: an axis, a position, and the parts before and from the position on. A
    /// part is a cut, or -1 - r for the block of rank r. The root is the first; one rank has none.
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

/// The shape of these extents.
[[nodiscard]] Shape shape_of(const Position& extent, std::size_t dimensions);

}  // namespace cellist::detail
