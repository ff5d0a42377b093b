// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mpi.h>

#include <cellist/cellist.hpp>

namespace bench {

/// Moves records from the device of each rank to the devices of all others, and does nothing else:
/// a copy to pinned memory, MPI_Alltoallv, and a copy from pinned memory. The steps do not overlap.
/// The times of an exchange are compared with these.
class BytesAlone {
public:
    /// Collective. `sent[r]` is the number of records of `record_bytes` bytes that this rank sends
    /// to rank r. Throws Error if this rank sends or receives more than 2^31 - 1 records in all.
    BytesAlone(const cellist::Device& device, MPI_Comm comm, std::vector<std::uint64_t> sent,
               std::size_t record_bytes);
    ~BytesAlone();
    BytesAlone(const BytesAlone&) = delete;
    BytesAlone& operator=(const BytesAlone&) = delete;

    /// Milliseconds of the steps on this rank.
    struct Times {
        double to_host_ms = 0;
        double exchange_ms = 0;
        double to_device_ms = 0;
    };
    /// Collective. Blocks.
    Times run();

    [[nodiscard]] std::uint64_t sent_bytes() const { return outgoing_.bytes; }
    [[nodiscard]] std::uint64_t received_bytes() const { return incoming_.bytes; }

private:
    // The records to or from all ranks, on the device and in pinned memory.
    struct Side {
        std::vector<int> counts;
        std::vector<int> offsets;
        std::uint64_t bytes = 0;
        cl::Buffer on_device;
        cl::Buffer pinned;
        void* on_host = nullptr;

        Side(const cellist::Device& device, const std::vector<std::uint64_t>& records,
             std::size_t record_bytes);
    };

    const cellist::Device& device_;
    MPI_Comm comm_;
    MPI_Datatype record_ = MPI_DATATYPE_NULL;
    Side outgoing_;
    Side incoming_;
};

}  // namespace bench
