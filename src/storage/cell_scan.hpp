// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include <cellist/detail/memory.hpp>
#include <cellist/device.hpp>
#include <cellist/kernel.hpp>

namespace cellist::detail {

/// Sums the counts of all cells, and computes where lists of these lengths start. The counts are
/// words of a head buffer, from `counts_at` on. No call tiles.
class CellScan {
public:
    CellScan(const MemoryOwner& device, std::uint64_t cells, cl_uint counts_at);
    /// The memory that it takes.
    [[nodiscard]] static std::uint64_t bytes_for(const DeviceInfo& device, std::uint64_t cells);

    struct Totals {
        cl_ulong sum = 0;      ///< of min(count, limit) over all cells
        cl_ulong longest = 0;  ///< the largest count
        cl_ulong hash = 0;     ///< of all counts and their cells
    };
    /// Enqueues the sums of min(count, limit).
    void sum(const cl::Buffer& heads, cl_uint limit);
    /// Enqueues a read of the totals of the last sum(). `totals` has them after the wait() of the
    /// ReadbackFence to which the caller adds this read.
    [[nodiscard]] PendingRead read_later(Totals& totals) const;
    /// Enqueues a write of the offsets of the lists, none over `capacity_nodes`: one for each cell,
    /// and the end of the last list. They may overwrite the counts. Call sum() first, with the same
    /// counts and no limit. `kept` are the offsets of lists that are part of the counts: where the
    /// capacity is too small, they keep their lengths, and others lose records.
    void write_offsets(const cl::Buffer& heads, const cl::Buffer& offsets,
                       std::uint64_t capacity_nodes, const Memory* kept = nullptr);

private:
    cl_uint group_;  ///< work-items
    cl_uint cells_;
    cl_uint counts_at_;
    std::uint64_t tiles_;
    Kernel tile_sums_;
    Kernel tile_starts_;
    Kernel tile_offsets_;
    Memory sums_;
    Memory hashes_;
    Memory maxima_;
    Memory totals_;
};

}  // namespace cellist::detail
