// SPDX-License-Identifier: MIT
#include "mpi/partition_plan.hpp"

#include <algorithm>
#include <string>

#include "device/distribution.hpp"

namespace cellist::detail {

using mpi::Block;
using mpi::PartitionOptions;

namespace {

constexpr std::array axis_names{"x", "y", "z", "w"};

std::string layers_text(std::uint64_t layers) {
    return std::to_string(layers) + (layers == 1 ? " layer" : " layers") + " of ghost cells";
}

std::string partition_text(const Shape& shape, const PartitionOptions& options) {
    std::string text = "the shape " + shape.to_string() + " with " + layers_text(options.ghosts);
    std::string periodic, blocks;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        if (options.periodic[axis])
            periodic += std::string(periodic.empty() ? "" : ", ") + axis_names[axis];
        blocks += (axis == 0 ? "" : "x") + std::to_string(options.blocks[axis]);
    }
    if (!periodic.empty()) text += ", periodic along " + periodic;
    if (options.blocks != PartitionOptions{}.blocks) text += ", in blocks of " + blocks;
    return text;
}

Block whole(const Shape& shape) {
    Block block;
    for (std::size_t axis = 0; axis < 4; ++axis) block.extent[axis] = shape.extent(axis);
    return block;
}

/// Returns whether the options name blocks; replaces each 0 by 1. Throws Error if the product is
/// not the number of ranks.
bool names_blocks(std::array<std::uint32_t, 4>& blocks, int ranks) {
    if (blocks == PartitionOptions{}.blocks) return false;
    std::uint64_t product = 1;
    std::string text;
    for (std::uint32_t& count : blocks) {
        if (count == 0) count = 1;
        product *= count;
        text += (text.empty() ? "" : "x") + std::to_string(count);
        if (product > static_cast<std::uint64_t>(ranks)) break;
    }
    if (product != static_cast<std::uint64_t>(ranks))
        throw Error("a partition into " + text + " blocks does not fit a communicator of " +
                    std::to_string(ranks) + " ranks: their product must be the number of ranks");
    return true;
}

/// Returns the position from `low` to `high` for which the weight of the layers before it is
/// nearest to part / parts of the sum. `miss` is the difference.
std::uint64_t cut_by_weight(const std::vector<std::uint64_t>& layers, std::uint64_t low,
                            std::uint64_t high, int part, int parts, double& miss) {
    double all = 0;
    for (const std::uint64_t layer : layers) all += static_cast<double>(layer);
    const double goal = all * part / parts;
    double before = 0;
    std::uint64_t best = low;
    miss = -1;
    for (std::uint64_t i = 0; i <= layers.size(); ++i) {
        const double off = before < goal ? goal - before : before - goal;
        if (i >= low && i <= high && (miss < 0 || off < miss)) best = i, miss = off;
        if (i < layers.size()) before += static_cast<double>(layers[i]);
    }
    return best;
}

}  // namespace

Shape shape_of(const Position& extent, std::size_t dimensions) {
    switch (dimensions) {
        case 1:
            return {extent[0]};
        case 2:
            return {extent[0], extent[1]};
        case 3:
            return {extent[0], extent[1], extent[2]};
        default:
            return {extent[0], extent[1], extent[2], extent[3]};
    }
}

PartitionPlan::PartitionPlan(MPI_Comm comm, const Shape& shape, const PartitionOptions& options,
                             const Weights* weights)
    : communicator_(comm), shape_(shape), options_(options) {
    const int ranks = communicator_.size();
    communicator_.require_same(partition_text(shape, options), "partitions");
    Weights sums;
    communicator_.together([&] {
        if (weights == nullptr) return;
        if (weights->size() != shape.cells())
            throw Error("a partition of " + std::to_string(shape.cells()) + " cells was given " +
                        std::to_string(weights->size()) + " weights: it needs one for each cell");
        sums = *weights;
    });
    communicator_.reduce(sums.data(), sums.size(), MPI_SUM);
    blocks_.resize(static_cast<std::size_t>(ranks), Block{{}, {0, 0, 0, 0}});
    cuts_.reserve(static_cast<std::size_t>(ranks));
    std::array<std::uint32_t, 4> grid = options.blocks;
    // All ranks compute the same cuts from the same numbers.
    if (weights == nullptr && names_blocks(grid, ranks)) {
        options_.blocks = grid;
        cut_into_grid({}, grid);
    } else {
        // Without any weight, blocks have about equal size.
        const bool weighs = std::any_of(sums.begin(), sums.end(), [](auto w) { return w > 0; });
        cut_in_two(whole(shape), 0, ranks, weighs ? &sums : nullptr);
    }
    choose_ghosts();
}

const Block& PartitionPlan::block(int rank) const {
    if (rank < 0 || rank >= communicator_.size())
        throw Error("rank " + std::to_string(rank) + " is not one of the " +
                    std::to_string(communicator_.size()) + " ranks of the partition");
    return blocks_[static_cast<std::size_t>(rank)];
}

cl_int PartitionPlan::add_cut(std::size_t axis, std::uint64_t position) {
    cuts_.push_back({static_cast<cl_int>(axis), static_cast<cl_int>(position), 0, 0});
    return static_cast<cl_int>(cuts_.size() - 1);
}

cl_int PartitionPlan::cut_into_grid(const std::array<std::uint32_t, 4>& first,
                                    const std::array<std::uint32_t, 4>& end) {
    const auto& grid = options_.blocks;
    const auto begin_of = [&](std::size_t axis, std::uint64_t i) {
        return i * shape_.extent(axis) / grid[axis];
    };
    for (std::size_t axis = 4; axis-- > 0;) {
        if (end[axis] - first[axis] < 2) continue;
        const std::uint32_t middle = first[axis] + (end[axis] - first[axis]) / 2;
        const cl_int cut = add_cut(axis, begin_of(axis, middle));
        std::array<std::uint32_t, 4> before = end, after = first;
        before[axis] = after[axis] = middle;
        const cl_int low = cut_into_grid(first, before);
        const cl_int high = cut_into_grid(after, end);
        cuts_[static_cast<std::size_t>(cut)][2] = low;
        cuts_[static_cast<std::size_t>(cut)][3] = high;
        return cut;
    }
    std::size_t rank = 0;
    Block block;
    for (std::size_t axis = 4; axis-- > 0;) {
        rank = rank * grid[axis] + first[axis];
        block.origin[axis] = begin_of(axis, first[axis]);
        block.extent[axis] = begin_of(axis, end[axis]) - block.origin[axis];
    }
    blocks_[rank] = block;
    return -1 - static_cast<cl_int>(rank);
}

std::vector<std::uint64_t> PartitionPlan::layer_weights(const Block& block, std::size_t axis,
                                                        const Weights& weights) const {
    std::vector<std::uint64_t> layers(block.extent[axis], 0);
    Position at{};
    for (at[3] = 0; at[3] < block.extent[3]; ++at[3])
        for (at[2] = 0; at[2] < block.extent[2]; ++at[2])
            for (at[1] = 0; at[1] < block.extent[1]; ++at[1]) {
                const std::uint64_t row = cell({block.origin[0], block.origin[1] + at[1],
                                                block.origin[2] + at[2], block.origin[3] + at[3]});
                for (at[0] = 0; at[0] < block.extent[0]; ++at[0])
                    layers[at[axis]] += weights[row + at[0]];
            }
    return layers;
}

/// Returns the axis along which to cut a block of cells of equal weight. If possible, both parts
/// are at least `width` cells long. A cut along the longest axis makes the shortest border. The
/// slowest axis is cut first unless another is more than three times as long: if no other axis is
/// divided, blocks are ranges of cells, and inserts take the least time.
std::size_t PartitionPlan::axis_to_cut(const Block& block, std::uint64_t width) const {
    const std::size_t slowest = shape_.dimensions() - 1;
    const auto merit = [&](std::size_t axis) {
        const std::uint64_t extent = block.extent[axis];
        return extent < 2 * width ? 0 : extent * (axis == slowest ? 3 : 1);
    };
    std::size_t best = slowest;
    for (std::size_t axis = slowest; axis-- > 0;)
        if (merit(axis) > merit(best)) best = axis;
    return best;
}

cl_int PartitionPlan::cut_in_two(const Block& block, int first_rank, int ranks,
                                 const Weights* weights) {
    if (ranks == 1) {
        blocks_[static_cast<std::size_t>(first_rank)] = block;
        return -1 - first_rank;
    }
    const int half = ranks / 2;
    const std::uint64_t width = std::max<std::uint64_t>(options_.ghosts, 1);
    std::size_t axis = axis_to_cut(block, width);
    const std::uint64_t extent = block.extent[axis];
    std::uint64_t before =
        std::max(extent * static_cast<std::uint64_t>(half) / static_cast<std::uint64_t>(ranks),
                 std::min(width, (extent + 1) / 2));
    if (weights != nullptr) {
        double least = -1;
        for (std::size_t i = shape_.dimensions(); i-- > 0;) {
            if (block.extent[i] < 2 * width) continue;
            double miss = 0;
            const std::uint64_t at = cut_by_weight(layer_weights(block, i, *weights), width,
                                                   block.extent[i] - width, half, ranks, miss);
            if (least < 0 || miss < least) least = miss, axis = i, before = at;
        }
    }
    const cl_int cut = add_cut(axis, block.origin[axis] + before);
    Block low = block, high = block;
    low.extent[axis] = before;
    high.origin[axis] += before;
    high.extent[axis] -= before;
    const cl_int low_part = cut_in_two(low, first_rank, half, weights);
    const cl_int high_part = cut_in_two(high, first_rank + half, ranks - half, weights);
    cuts_[static_cast<std::size_t>(cut)][2] = low_part;
    cuts_[static_cast<std::size_t>(cut)][3] = high_part;
    return cut;
}

void PartitionPlan::choose_ghosts() {
    const std::uint64_t layers = options_.ghosts;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        std::uint64_t least = shape_.extent(axis);
        std::size_t least_rank = 0;
        for (std::size_t rank = 0; rank < blocks_.size(); ++rank)
            if (blocks_[rank].cells() > 0 && blocks_[rank].extent[axis] < least)
                least = blocks_[rank].extent[axis], least_rank = rank;
        if (least == shape_.extent(axis)) continue;
        ghosts_[axis] = layers;
        if (layers > least)
            throw Error(layers_text(layers) + " would be wider than the block of rank " +
                        std::to_string(least_rank) + ", which has " + std::to_string(least) +
                        " cells along " + axis_names[axis] +
                        ": use fewer ranks, fewer layers or other blocks");
        if (options_.periodic[axis] && layers > 0 && 2 * layers >= shape_.extent(axis))
            throw Error(layers_text(layers) + " on both sides would meet around the " +
                        std::to_string(shape_.extent(axis)) + " cells along " + axis_names[axis] +
                        ", which is periodic and divided: use fewer layers, or blocks that do not "
                        "divide this axis");
    }
}

Position PartitionPlan::position(std::uint64_t cell) const {
    Position at{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        at[axis] = cell % shape_.extent(axis);
        cell /= shape_.extent(axis);
    }
    return at;
}

std::uint64_t PartitionPlan::cell(const Position& at) const {
    std::uint64_t cell = 0;
    for (std::size_t axis = 4; axis-- > 0;) cell = cell * shape_.extent(axis) + at[axis];
    return cell;
}

int PartitionPlan::owner(const Position& at) const {
    cl_int part = cuts_.empty() ? -1 : 0;
    while (part >= 0) {
        const auto& cut = cuts_[static_cast<std::size_t>(part)];
        const std::uint64_t coordinate = at[static_cast<std::size_t>(cut[0])];
        part = coordinate < static_cast<std::uint64_t>(cut[1]) ? cut[2] : cut[3];
    }
    return -1 - part;
}

Position PartitionPlan::held(int rank) const {
    const Block& box = block(rank);
    Position extents{};
    if (box.cells() == 0) return extents;
    for (std::size_t axis = 0; axis < 4; ++axis)
        extents[axis] = box.extent[axis] + 2 * ghosts_[axis];
    return extents;
}

std::vector<GhostCopy> PartitionPlan::ghost_copies() const {
    std::vector<GhostCopy> copies;
    if (own().cells() == 0 || options_.ghosts == 0) return copies;
    const auto signed_of = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
    for (int rank = 0; rank < communicator_.size(); ++rank) {
        const Block& other = block(rank);
        if (other.cells() == 0) continue;
        // The digits of `shifts` to base 3: each axis wraps around -1, 0 or 1 times.
        for (int shifts = 0; shifts < 81; ++shifts) {
            GhostCopy copy{.rank = rank, .first = {}, .extent = {}, .target = {}};
            bool exists = true, moves = rank != communicator_.rank();
            for (std::size_t axis = 0, rest = static_cast<std::size_t>(shifts); axis < 4;
                 ++axis, rest /= 3) {
                const std::int64_t turns = signed_of(rest % 3) - 1;
                const std::int64_t ghosts = signed_of(ghosts_[axis]);
                if (turns != 0 && (ghosts == 0 || !options_.periodic[axis])) exists = false;
                if (turns != 0) moves = true;
                const std::int64_t shift = turns * signed_of(shape_.extent(axis));
                const std::int64_t mine = signed_of(own().origin[axis]) + shift;
                const std::int64_t theirs = signed_of(other.origin[axis]) - ghosts;
                const std::int64_t begin = std::max(mine, theirs);
                const std::int64_t end =
                    std::min(mine + signed_of(own().extent[axis]),
                             signed_of(other.origin[axis] + other.extent[axis]) + ghosts);
                if (begin >= end) exists = false;
                copy.first[axis] = static_cast<std::uint64_t>(begin - mine + ghosts);
                copy.extent[axis] = static_cast<std::uint64_t>(end - begin);
                copy.target[axis] = static_cast<std::uint64_t>(begin - theirs);
            }
            if (exists && moves) copies.push_back(copy);
        }
    }
    return copies;
}

cellist_distribution PartitionPlan::distribution() const {
    cellist_view domain{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        domain.extent[axis] = static_cast<cl_uint>(shape_.extent(axis));
        if (options_.periodic[axis]) domain.periodic_axes |= 1U << axis;
    }
    domain.cells = static_cast<cl_uint>(shape_.cells());
    cellist_distribution all = whole_distribution(domain);
    all.inserts = 0;
    const Position extents = held(communicator_.rank());
    for (std::size_t axis = 0; axis < 4; ++axis) {
        all.origin[axis] = static_cast<cl_uint>(own().origin[axis]);
        all.block[axis] = static_cast<cl_uint>(own().extent[axis]);
        all.ghosts[axis] = static_cast<cl_uint>(ghosts_[axis]);
        all.held[axis] = static_cast<cl_uint>(extents[axis]);
    }
    set_strides(all.held, all.held_stride);
    const std::array<cl_uint, 4> held_stride{1, all.held_stride[0], all.held_stride[1],
                                             all.held_stride[2]};
    for (std::size_t axis = 0; axis < 4; ++axis)
        all.own_offset += (all.ghosts[axis] - all.origin[axis]) * held_stride[axis];
    // If only the slowest axis is divided, a block is a range of cells, with the strides of the
    // whole shape.
    const std::size_t slowest = shape_.dimensions() - 1;
    bool is_range = own().cells() == 0;
    if (!is_range) {
        is_range = true;
        for (std::size_t axis = 0; axis < slowest; ++axis)
            is_range = is_range && own().extent[axis] == shape_.extent(axis) && ghosts_[axis] == 0;
    }
    all.range_cells = is_range ? static_cast<cl_uint>(own().cells()) : CELLIST_NONE;
    all.range_first = static_cast<cl_uint>(cell(own().origin));
    return all;
}

}  // namespace cellist::detail
