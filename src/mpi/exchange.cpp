// SPDX-License-Identifier: MIT
#include "mpi/exchange.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "device/device_state.hpp"
#include "device/view.hpp"

namespace cellist::detail {

namespace {

constexpr int tag = 1;

/// The size in bytes of chunk k of a message of `bytes` bytes.
std::uint64_t chunk(std::uint64_t bytes, std::uint64_t k, std::uint64_t chunk_bytes) {
    const std::uint64_t begin = std::min(k * chunk_bytes, bytes);
    return std::min(chunk_bytes, bytes - begin);
}

}  // namespace

Exchange::~Exchange() { release(); }

void Exchange::release() noexcept {
    for (auto* pair : {&out_, &in_})
        for (Staging& staging : *pair) {
            if (staging.bytes != nullptr)
                clEnqueueUnmapMemObject(device_->queue(), staging.memory(), staging.bytes, 0,
                                        nullptr, nullptr);
            staging = Staging();
        }
    staged_bytes_ = 0;
}

void Exchange::set_message_bytes(std::uint64_t bytes) {
    release();
    message_bytes_ = bytes;
    within_host_.set_piece_bytes(bytes);
}

/// Makes page-locked room for chunks of messages of up to `bytes` bytes.
void Exchange::stage(std::uint64_t bytes) {
    const std::uint64_t needed = std::min(std::bit_ceil(bytes), message_bytes_);
    if (bytes == 0 || needed <= staged_bytes_) return;
    release();
    opencl([&] {
        for (auto* pair : {&out_, &in_})
            for (Staging& staging : *pair) {
                staging.memory =
                    cl::Buffer(device_->context, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, needed);
                staging.bytes = static_cast<std::byte*>(device_->queue.enqueueMapBuffer(
                    staging.memory, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, needed));
            }
    });
    staged_bytes_ = needed;
}

std::uint64_t Exchange::run(const Memory& from, const std::vector<cl_uint>& offsets,
                            std::size_t element_bytes) {
    const auto ranks = static_cast<std::size_t>(communicator_.size());
    const auto self = static_cast<std::size_t>(communicator_.rank());
    std::vector<std::uint64_t> counts(ranks);
    for (std::size_t r = 0; r < ranks; ++r) counts[r] = offsets[r + 1] - offsets[r];
    const std::vector<std::uint64_t> arriving = communicator_.transpose(counts);
    // In bytes: for rank r, sent[r] ... sent[r + 1] - 1; from rank r, received[r] ...
    std::vector<std::uint64_t> sent(ranks + 1, offsets[0] * element_bytes), received(ranks + 1, 0);
    for (std::size_t r = 0; r < ranks; ++r) {
        sent[r + 1] = sent[r] + counts[r] * element_bytes;
        received[r + 1] = received[r] + arriving[r] * element_bytes;
    }
    const std::uint64_t count = received[ranks] / element_bytes;

    const bool shares_memory = within_host_.prepare(sent, received);
    std::vector<bool> gets_messages(ranks, true);
    gets_messages[self] = false;
    if (shares_memory)
        for (const std::size_t r : communicator_.host_ranks()) gets_messages[r] = false;
    const auto part = [&](std::size_t r, const std::vector<std::uint64_t>& places) {
        return Part{static_cast<int>(r), places[r],
                    gets_messages[r] ? places[r + 1] - places[r] : 0};
    };
    std::uint64_t longest = 0;
    for (std::size_t r = 0; r < ranks; ++r)
        longest = std::max({longest, part(r, sent).bytes, part(r, received).bytes});
    communicator_.together([&] {
        if (count > CELLIST_CAPACITY_NODES_MAX)
            throw MemoryError(std::to_string(count) + " records arrive, and a rank takes at most " +
                              std::to_string(CELLIST_CAPACITY_NODES_MAX) + ": use more ranks");
        if (received[ranks] > received_.size_bytes())
            received_ = Memory(device_, count, element_bytes, "received records");
        stage(longest);
        if (arriving[self] == 0) return;
        opencl([&] {
            device_->ordered_queue().enqueueCopyBuffer(from.cl(), received_.cl(), sent[self],
                                                       received[self],
                                                       arriving[self] * element_bytes);
        });
    });
    if (shares_memory) within_host_.run(from, received_, attempts_);
    for (std::size_t distance = 1; distance < ranks; ++distance)
        send_and_receive(from, part((self + distance) % ranks, sent),
                         part((self + ranks - distance) % ranks, received));
    communicator_.agree(attempts_.take());
    return count;
}

/// Chunk k + 1 is copied from the device, and chunk k - 1 to it, while chunk k is in flight.
void Exchange::send_and_receive(const Memory& from, const Part& to_send, const Part& to_receive) {
    // Both ranks cut the same bytes into the same chunks.
    const std::uint64_t size = message_bytes_;
    const std::uint64_t sends = (to_send.bytes + size - 1) / size;
    const std::uint64_t receives = (to_receive.bytes + size - 1) / size;
    const auto read = [&](std::uint64_t k) {
        Staging& out = out_[k % 2];
        // The send of chunk k - 2 reads the same bytes.
        MPI_Wait(&out.message, MPI_STATUS_IGNORE);
        attempts_.make([&] {
            device_->ordered_queue().enqueueReadBuffer(
                from.cl(), CL_FALSE, to_send.first_byte + k * size, chunk(to_send.bytes, k, size),
                out.bytes, nullptr, &out.used);
            device_->queue.flush();
        });
    };
    const auto receive = [&](std::uint64_t k) {
        Staging& in = in_[k % 2];
        attempts_.wait_for(in.used);
        MPI_Irecv(in.bytes, static_cast<int>(chunk(to_receive.bytes, k, size)), MPI_BYTE,
                  to_receive.rank, tag, communicator_.get(), &in.message);
    };
    if (receives > 0) receive(0);
    if (sends > 0) read(0);
    for (std::uint64_t k = 0; k < std::max(sends, receives); ++k) {
        if (k + 1 < receives) receive(k + 1);
        if (k < sends) {
            Staging& out = out_[k % 2];
            attempts_.wait_for(out.used);
            MPI_Isend(out.bytes, static_cast<int>(chunk(to_send.bytes, k, size)), MPI_BYTE,
                      to_send.rank, tag, communicator_.get(), &out.message);
        }
        if (k + 1 < sends) read(k + 1);
        if (k < receives) {
            Staging& in = in_[k % 2];
            MPI_Wait(&in.message, MPI_STATUS_IGNORE);
            attempts_.make([&] {
                device_->ordered_queue().enqueueWriteBuffer(
                    received_.cl(), CL_FALSE, to_receive.first_byte + k * size,
                    chunk(to_receive.bytes, k, size), in.bytes, nullptr, &in.used);
                device_->queue.flush();
            });
        }
    }
    for (Staging& out : out_) {
        MPI_Wait(&out.message, MPI_STATUS_IGNORE);
        attempts_.wait_for(out.used);
    }
    for (Staging& in : in_) attempts_.wait_for(in.used);
}

}  // namespace cellist::detail
