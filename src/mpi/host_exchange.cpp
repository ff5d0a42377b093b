// SPDX-License-Identifier: MIT
#include "mpi/host_exchange.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace cellist::detail {

namespace {

/// The size of the first pieces. The ranks share no memory if there is no room for them.
constexpr std::uint64_t piece_bytes_min = 65536;

}  // namespace

HostExchange::HostExchange(const Communicator& communicator, const MemoryOwner& device)
    : communicator_(communicator), device_(device), memory_(communicator) {
    if (communicator.host_ranks().size() > 1)
        from_device_ = opencl([&] { return cl::CommandQueue(device->context, device->device); });
}

/// Adds a part, or makes the last one longer.
void HostExchange::add_part(std::vector<Part>& parts, const Part& part) {
    if (part.bytes == 0) return;
    if (!parts.empty()) {
        Part& last = parts.back();
        if (last.sender == part.sender && last.in_stream + last.bytes == part.in_stream &&
            last.in_device + last.bytes == part.in_device) {
            last.bytes += part.bytes;
            return;
        }
    }
    parts.push_back(part);
}

bool HostExchange::prepare(const std::vector<std::uint64_t>& sent,
                           const std::vector<std::uint64_t>& received) {
    const std::vector<std::size_t>& ranks = communicator_.host_ranks();
    const std::size_t count = ranks.size();
    if (count == 1 || !shares_memory_) return false;
    const auto self = static_cast<std::size_t>(communicator_.host_rank());
    // From each rank of the host to each.
    std::vector<std::uint64_t> bytes(count * count);
    for (std::size_t rank = 0; rank < count; ++rank)
        bytes[self * count + rank] = sent[ranks[rank] + 1] - sent[ranks[rank]];
    MPI_Allgather(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, bytes.data(), static_cast<int>(count),
                  MPI_UINT64_T, communicator_.host());
    outgoing_.clear();
    incoming_.clear();
    std::uint64_t longest = 0;
    for (std::size_t sender = 0; sender < count; ++sender) {
        std::uint64_t at = 0;
        for (std::size_t distance = 1; distance < count; ++distance) {
            const std::size_t receiver = (sender + distance) % count;
            const std::uint64_t size = bytes[sender * count + receiver];
            if (sender == self) add_part(outgoing_, {sender, at, sent[ranks[receiver]], size});
            if (receiver == self) add_part(incoming_, {sender, at, received[ranks[sender]], size});
            at += size;
        }
        longest = std::max(longest, at);
    }
    if (!make_room(longest)) return false;
    pieces_ = longest == 0 ? 0 : (longest + piece_bytes_ - 1) / piece_bytes_;
    return true;
}

/// Makes room for pieces of a stream, or for smaller ones if there is less. Collective among the
/// ranks of the host.
bool HostExchange::make_room(std::uint64_t stream_bytes) {
    std::uint64_t piece =
        std::min(std::max(std::bit_ceil(stream_bytes), piece_bytes_min), piece_bytes_max_);
    if (stream_bytes == 0 || piece <= piece_bytes_) return true;
    release();
    while (!memory_.allocate(2 * piece)) {
        piece /= 2;
        piece_bytes_max_ = piece;
        if (piece >= piece_bytes_min) continue;
        shares_memory_ = false;
        return false;
    }
    piece_bytes_ = piece;
    lock_pages();
    return true;
}

/// Locks the pages of all parts, which makes copies several times as fast. Does without where the
/// driver cannot.
void HostExchange::lock_pages() {
    locked_.resize(communicator_.host_ranks().size());
    for (std::size_t rank = 0; rank < locked_.size(); ++rank) {
        try {
            cl::Buffer part(device_->context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR,
                            memory_.part_bytes(), memory_.part(rank));
            device_->queue.enqueueMapBuffer(part, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                                            memory_.part_bytes());
            locked_[rank] = std::move(part);
        } catch (const cl::Error&) {
            // The memory is then as any other to the driver.
        }
    }
}

void HostExchange::release() noexcept {
    if (piece_bytes_ == 0) return;
    for (std::size_t rank = 0; rank < locked_.size(); ++rank)
        if (locked_[rank]() != nullptr)
            clEnqueueUnmapMemObject(device_->queue(), locked_[rank](), memory_.part(rank), 0,
                                    nullptr, nullptr);
    // No command may use the memory any more.
    clFinish(device_->queue());
    clFinish(from_device_());
    locked_.clear();
    memory_.release();
    piece_bytes_ = 0;
}

void HostExchange::set_piece_bytes(std::uint64_t bytes) {
    release();
    piece_bytes_max_ = bytes;
}

/// Calls `copy` with the place on the device, the place in the shared memory and the size of each
/// copy that a piece of the streams needs.
void HostExchange::for_each_copy(
    const std::vector<Part>& parts, std::uint64_t piece,
    std::invocable<std::uint64_t, std::byte*, std::uint64_t> auto&& copy) const {
    const std::uint64_t first = piece * piece_bytes_, end = first + piece_bytes_;
    for (const Part& part : parts) {
        const std::uint64_t from = std::max(part.in_stream, first);
        const std::uint64_t to = std::min(part.in_stream + part.bytes, end);
        if (from < to)
            copy(part.in_device + (from - part.in_stream),
                 memory_.part(part.sender) + piece % 2 * piece_bytes_ + (from - first), to - from);
    }
}

void HostExchange::run(const Memory& from, const Memory& to, Attempts& attempts) {
    if (pieces_ == 0) return;
    cl::Event read, written;
    const auto read_piece = [&](std::uint64_t piece) {
        attempts.make([&] {
            for_each_copy(outgoing_, piece,
                          [&](std::uint64_t at, std::byte* host, std::uint64_t bytes) {
                              from_device_.enqueueReadBuffer(from.cl(), CL_FALSE, at, bytes, host,
                                                             nullptr, &read);
                          });
            from_device_.flush();
        });
    };
    attempts.make([&] {
        const std::vector<cl::Event> made{device_->enqueue_marker()};
        device_->queue.flush();
        from_device_.enqueueBarrierWithWaitList(&made);
    });
    read_piece(0);
    for (std::uint64_t piece = 0; piece < pieces_; ++piece) {
        attempts.wait_for(read);
        attempts.wait_for(written);
        // Now all ranks have this piece of each stream, and none uses the last one any more.
        memory_.synchronise();
        if (piece + 1 < pieces_) read_piece(piece + 1);
        attempts.make([&] {
            for_each_copy(incoming_, piece,
                          [&](std::uint64_t at, const std::byte* host, std::uint64_t bytes) {
                              device_->ordered_queue().enqueueWriteBuffer(
                                  to.cl(), CL_FALSE, at, bytes, host, nullptr, &written);
                          });
            device_->queue.flush();
        });
    }
    attempts.wait_for(written);
}

}  // namespace cellist::detail
