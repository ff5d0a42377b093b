#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/kernel.hpp>

namespace cellist::detail {

/// Sums over the counts of all cells, and where lists start that have these lengths. The counts are
/// words of a head buffer, from `counts_at` on.
class CellScan {
public:
    CellScan(std::shared_ptr<DeviceState> device, std::uint64_t cells, cl_uint counts_at);

    struct Sums {
        std::vector<cl_ulong> before;  ///< the sum of all blocks before each block
        std::uint64_t total = 0;       ///< sum of min(count, limit) over all cells
        cl_uint longest = 0;           ///< the largest count
    };
    /// Blocks.
    Sums sums(const cl::Buffer& heads, cl_uint limit);

    /// Writes the offsets of the lists, none over `capacity_nodes`, to the begin of the heads: one a
    /// cell, and the end of the last list. `sums` are those without a limit.
    void write_offsets(const cl::Buffer& heads, const Sums& sums, std::uint64_t capacity_nodes);

private:
    std::shared_ptr<DeviceState> device_;
    cl_uint cells_;
    cl_uint counts_at_;
    std::uint64_t blocks_;
    Kernel block_sums_;
    Kernel block_offsets_;
    Memory sums_;
    Memory maxima_;
};

}  // namespace cellist::detail
