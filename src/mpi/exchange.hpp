// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <cellist/detail/memory.hpp>

#include "mpi/attempts.hpp"
#include "mpi/communicator.hpp"
#include "mpi/host_exchange.hpp"

namespace cellist::detail {

/// Sends elements of device memory between all ranks: between ranks of one host as HostExchange
/// does, and otherwise in messages, through four page-locked host buffers of at most one message
/// each. Never passes OpenCL memory to MPI.
class Exchange {
public:
    Exchange(const Communicator& communicator, MemoryOwner device)
        : communicator_(communicator),
          device_(std::move(device)),
          within_host_(communicator, device_) {}
    ~Exchange();
    Exchange(const Exchange&) = delete;
    Exchange& operator=(const Exchange&) = delete;

    /// Sends the elements offsets[r] ... offsets[r + 1] - 1 of `from` to each rank r. Returns the
    /// number of elements that arrive; they are in received(), in the order of the ranks that sent
    /// them. Collective. Blocks. Throws on all ranks: MemoryError if more elements arrive than a
    /// pool can hold or memory has room for, and OpenClError.
    std::uint64_t run(const Memory& from, const std::vector<cl_uint>& offsets,
                      std::size_t element_bytes);
    [[nodiscard]] const Memory& received() const { return received_; }

    /// Sets the largest size of a message, 16 MiB by default, and of a piece of HostExchange.
    void set_message_bytes(std::uint64_t bytes);
    /// Sets whether the ranks of a host share memory if they can.
    void set_shares_memory(bool shares) { within_host_.set_shares_memory(shares); }

private:
    struct Staging {
        cl::Buffer memory;
        std::byte* bytes = nullptr;
        cl::Event used;  ///< the last copy between the device and the bytes
        MPI_Request message = MPI_REQUEST_NULL;
    };
    struct Part {
        int rank;
        std::uint64_t first_byte;
        std::uint64_t bytes;
    };

    void stage(std::uint64_t bytes);
    void release() noexcept;
    void send_and_receive(const Memory& from, const Part& to_send, const Part& to_receive);

    const Communicator& communicator_;
    MemoryOwner device_;
    HostExchange within_host_;
    Memory received_;
    std::uint64_t message_bytes_ = std::uint64_t{16} << 20;
    std::uint64_t staged_bytes_ = 0;
    std::array<Staging, 2> out_;
    std::array<Staging, 2> in_;
    Attempts attempts_;
};

}  // namespace cellist::detail
