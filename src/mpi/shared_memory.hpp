// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mpi/communicator.hpp"

namespace cellist::detail {

/// Memory that all ranks of a host read and write: a part of the same size for each rank.
class SharedMemory {
public:
    explicit SharedMemory(const Communicator& communicator) : communicator_(communicator) {}
    ~SharedMemory() { release(); }
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    /// Makes parts of `bytes`, rounded up to whole pages, instead of those from before. Collective
    /// among the ranks of the host. If there is no room for a part of any rank, or ranks cannot see
    /// each other's memory, returns false on all of them and has no parts.
    [[nodiscard]] bool allocate(std::uint64_t bytes);
    /// Local. Other ranks keep the part of this rank until they release it.
    void release() noexcept;

    /// The part of a rank, by its rank on the host. Whole pages.
    [[nodiscard]] std::byte* part(std::size_t host_rank) const { return parts_[host_rank]; }
    /// The size of each part.
    [[nodiscard]] std::uint64_t part_bytes() const { return part_bytes_; }
    /// Makes what each rank wrote before it visible to the others after it. Collective among the
    /// ranks of the host.
    void synchronise() const;

private:
    const Communicator& communicator_;
    std::vector<std::byte*> parts_;  ///< null where there is none
    std::uint64_t part_bytes_ = 0;
};

}  // namespace cellist::detail
