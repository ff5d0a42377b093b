// SPDX-License-Identifier: MIT
#include "bytes_alone.hpp"

#include <limits>
#include <string>

#include "stopwatch.hpp"

namespace bench {
namespace {

std::vector<std::uint64_t> received_by(MPI_Comm comm, const std::vector<std::uint64_t>& sent) {
    std::vector<std::uint64_t> received(sent.size());
    MPI_Alltoall(sent.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, comm);
    return received;
}

}  // namespace

BytesAlone::Side::Side(const cellist::Device& device, const std::vector<std::uint64_t>& records,
                       std::size_t record_bytes) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : records) {
        offsets.push_back(static_cast<int>(sum));
        counts.push_back(static_cast<int>(count));
        sum += count;
        if (sum > std::numeric_limits<int>::max())
            throw cellist::Error("MPI_Alltoallv cannot move " + std::to_string(sum) +
                                 " records of a rank: the limit is 2^31 - 1");
    }
    bytes = sum * record_bytes;
    if (bytes == 0) return;
    on_device = cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes);
    pinned = cl::Buffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes);
    on_host =
        device.queue().enqueueMapBuffer(pinned, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes);
    // Touches all pages before the timed runs.
    device.queue().enqueueFillBuffer(on_device, cl_uint{0}, 0, bytes / 4 * 4);
    device.queue().enqueueReadBuffer(on_device, CL_TRUE, 0, bytes, on_host);
}

BytesAlone::BytesAlone(const cellist::Device& device, MPI_Comm comm,
                       std::vector<std::uint64_t> sent, std::size_t record_bytes)
    : device_(device),
      comm_(comm),
      outgoing_(device, sent, record_bytes),
      incoming_(device, received_by(comm, sent), record_bytes) {
    MPI_Type_contiguous(static_cast<int>(record_bytes), MPI_BYTE, &record_);
    MPI_Type_commit(&record_);
}

BytesAlone::~BytesAlone() {
    MPI_Type_free(&record_);
    for (const Side* side : {&outgoing_, &incoming_})
        if (side->on_host != nullptr)
            device_.queue().enqueueUnmapMemObject(side->pinned, side->on_host);
    device_.queue().finish();
}

BytesAlone::Times BytesAlone::run() {
    const cl::CommandQueue& queue = device_.queue();
    Times times;
    support::Stopwatch stopwatch;
    const auto lap = [&](double& ms) {
        ms = stopwatch.ms();
        stopwatch = {};
    };
    if (outgoing_.bytes != 0)
        queue.enqueueReadBuffer(outgoing_.on_device, CL_TRUE, 0, outgoing_.bytes,
                                outgoing_.on_host);
    lap(times.to_host_ms);
    MPI_Alltoallv(outgoing_.on_host, outgoing_.counts.data(), outgoing_.offsets.data(), record_,
                  incoming_.on_host, incoming_.counts.data(), incoming_.offsets.data(), record_,
                  comm_);
    lap(times.exchange_ms);
    if (incoming_.bytes != 0)
        queue.enqueueWriteBuffer(incoming_.on_device, CL_TRUE, 0, incoming_.bytes,
                                 incoming_.on_host);
    lap(times.to_device_ms);
    return times;
}

}  // namespace bench
