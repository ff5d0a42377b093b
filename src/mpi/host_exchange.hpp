// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <cellist/detail/memory.hpp>

#include "mpi/attempts.hpp"
#include "mpi/communicator.hpp"
#include "mpi/shared_memory.hpp"

namespace cellist::detail {

/// Copies bytes between the devices of the ranks of a host, through memory that they share. Never
/// passes OpenCL memory to MPI.
///
/// Each rank sends a stream: its bytes for the next rank of the host, then those for the rank after
/// that, and so on. In each round, a rank copies the next piece of its stream from its device into
/// its part of the memory, and the others copy theirs out of it. A part has room for two pieces, so
/// both copies run at the same time.
class HostExchange {
public:
    /// Throws OpenClError.
    HostExchange(const Communicator& communicator, const MemoryOwner& device);
    ~HostExchange() { release(); }
    HostExchange(const HostExchange&) = delete;
    HostExchange& operator=(const HostExchange&) = delete;

    /// Plans an exchange, and makes room for it. This rank's bytes for rank r are sent[r] ...
    /// sent[r + 1] - 1; those from rank r will be received[r] ... received[r + 1] - 1. Returns
    /// false if the ranks of the host cannot share memory: send messages instead. Collective among
    /// the ranks of the host, which all get the same result. They must all have returned before one
    /// of them calls run().
    [[nodiscard]] bool prepare(const std::vector<std::uint64_t>& sent,
                               const std::vector<std::uint64_t>& received);
    /// Makes the exchange, between all ranks of the host but not from a rank to itself. Collective
    /// among the ranks of the host, which must all have returned before one of them calls prepare()
    /// again. Blocks until the bytes have arrived.
    void run(const Memory& from, const Memory& to, Attempts& attempts);

    /// Sets the largest size of a piece; 4 MiB by default. Collective.
    void set_piece_bytes(std::uint64_t bytes);
    /// Sets whether the ranks share memory if they can. Collective.
    void set_shares_memory(bool shares) { shares_memory_ = shares; }

private:
    /// Bytes that are together in a stream, and in the memory of a device.
    struct Part {
        std::size_t sender;       ///< its rank on the host
        std::uint64_t in_stream;  ///< its first byte there
        std::uint64_t in_device;
        std::uint64_t bytes;
    };
    static void add_part(std::vector<Part>& parts, const Part& part);
    void for_each_copy(const std::vector<Part>& parts, std::uint64_t piece,
                       std::invocable<std::uint64_t, std::byte*, std::uint64_t> auto&& copy) const;
    [[nodiscard]] bool make_room(std::uint64_t stream_bytes);
    void lock_pages();
    void release() noexcept;

    const Communicator& communicator_;
    MemoryOwner device_;
    cl::CommandQueue from_device_;  ///< of this class alone, because copies in one queue take turns
    SharedMemory memory_;
    std::vector<cl::Buffer> locked_;  ///< the parts of the memory; null where locking has failed
    std::uint64_t piece_bytes_ = 0;   ///< what a part has room for, twice
    std::uint64_t piece_bytes_max_ = std::uint64_t{4} << 20;
    bool shares_memory_ = true;
    std::vector<Part> outgoing_;
    std::vector<Part> incoming_;
    std::uint64_t pieces_ = 0;  ///< of the longest stream
};

}  // namespace cellist::detail
