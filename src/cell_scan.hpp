#pragma once

#include <cstdint>
#include <memory>

#include <cellist/detail/memory.hpp>
#include <cellist/kernel.hpp>

namespace cellist::detail {

/// Sums over the counts of all cells, and where lists start that have these lengths. The counts are
/// words of a head buffer, from `counts_at` on. Nothing blocks.
class CellScan {
public:
    CellScan(std::shared_ptr<DeviceState> device, std::uint64_t cells, cl_uint counts_at);

    struct Totals {
        cl_ulong sum = 0;      ///< of min(count, limit) over all cells
        cl_ulong longest = 0;  ///< the largest count
    };
    /// Enqueues the sums of min(count, limit).
    void sum(const cl::Buffer& heads, cl_uint limit);
    /// Enqueues the reading of the totals of the last sum(): `totals` has them once the event has
    /// completed.
    [[nodiscard]] Reading read_later(Totals& totals) const;
    /// The totals of the last sum(). Blocks.

    /// Writes the offsets of the lists, none over `capacity_nodes`, to the begin of the heads: one a
    /// cell, and the end of the last list. Follows a sum() without a limit.
    void write_offsets(const cl::Buffer& heads, std::uint64_t capacity_nodes);

private:
    std::shared_ptr<DeviceState> device_;
    cl_uint cells_;
    cl_uint counts_at_;
    std::uint64_t blocks_;
    Kernel block_sums_;
    Kernel block_starts_;
    Kernel block_offsets_;
    Memory sums_;
    Memory maxima_;
    Memory totals_;
};

}  // namespace cellist::detail
