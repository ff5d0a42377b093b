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

void wait_for(cl::Event& event) {
    if (event() != nullptr) opencl([&] { event.wait(); });
    event = cl::Event();
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

/// Keeps an error of the device until all messages have arrived, because other ranks wait for them.
void Exchange::attempt(const std::function<void()>& call) {
    if (error_) return;
    try {
        call();
    } catch (...) {
        error_ = std::current_exception();
    }
}

std::uint64_t Exchange::run(const Memory& from, const std::vector<cl_uint>& offsets,
                            std::size_t element_bytes) {
    const auto ranks = static_cast<std::uint64_t>(communicator_.size());
    const auto self = static_cast<std::uint64_t>(communicator_.rank());
    std::vector<std::uint64_t> counts(ranks);
    for (std::uint64_t r = 0; r < ranks; ++r) counts[r] = offsets[r + 1] - offsets[r];
    const std::vector<std::uint64_t> arriving = communicator_.transpose(counts);
    std::vector<std::uint64_t> places(ranks + 1, 0);
    for (std::uint64_t r = 0; r < ranks; ++r) places[r + 1] = places[r] + arriving[r];

    std::uint64_t longest = 0;
    for (std::uint64_t r = 0; r < ranks; ++r)
        if (r != self) longest = std::max({longest, counts[r], arriving[r]});
    communicator_.together([&] {
        if (places[ranks] > CELLIST_CAPACITY_NODES_MAX)
            throw MemoryError(std::to_string(places[ranks]) +
                              " records arrive, and a rank takes at most " +
                              std::to_string(CELLIST_CAPACITY_NODES_MAX) + ": use more ranks");
        if (places[ranks] * element_bytes > received_.size_bytes())
            received_ = Memory(device_, places[ranks], element_bytes, "received records");
        stage(longest * element_bytes);
        if (arriving[self] == 0) return;
        opencl([&] {
            device_->ordered_queue().enqueueCopyBuffer(
                from.cl(), received_.cl(), offsets[self] * element_bytes,
                places[self] * element_bytes, arriving[self] * element_bytes);
        });
    });
    for (std::uint64_t distance = 1; distance < ranks; ++distance) {
        const std::uint64_t to = (self + distance) % ranks;
        const std::uint64_t source = (self + ranks - distance) % ranks;
        send_and_receive(
            from, {static_cast<int>(to), offsets[to] * element_bytes, counts[to] * element_bytes},
            {static_cast<int>(source), places[source] * element_bytes,
             arriving[source] * element_bytes});
    }
    communicator_.agree(std::exchange(error_, nullptr));
    return places[ranks];
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
        attempt([&] {
            opencl([&] {
                device_->ordered_queue().enqueueReadBuffer(
                    from.cl(), CL_FALSE, to_send.first_byte + k * size,
                    chunk(to_send.bytes, k, size), out.bytes, nullptr, &out.used);
                device_->queue.flush();
            });
        });
    };
    const auto receive = [&](std::uint64_t k) {
        Staging& in = in_[k % 2];
        attempt([&] { wait_for(in.used); });
        MPI_Irecv(in.bytes, static_cast<int>(chunk(to_receive.bytes, k, size)), MPI_BYTE,
                  to_receive.rank, tag, communicator_.get(), &in.message);
    };
    if (receives > 0) receive(0);
    if (sends > 0) read(0);
    for (std::uint64_t k = 0; k < std::max(sends, receives); ++k) {
        if (k + 1 < receives) receive(k + 1);
        if (k < sends) {
            Staging& out = out_[k % 2];
            attempt([&] { wait_for(out.used); });
            MPI_Isend(out.bytes, static_cast<int>(chunk(to_send.bytes, k, size)), MPI_BYTE,
                      to_send.rank, tag, communicator_.get(), &out.message);
        }
        if (k + 1 < sends) read(k + 1);
        if (k < receives) {
            Staging& in = in_[k % 2];
            MPI_Wait(&in.message, MPI_STATUS_IGNORE);
            attempt([&] {
                opencl([&] {
                    device_->ordered_queue().enqueueWriteBuffer(
                        received_.cl(), CL_FALSE, to_receive.first_byte + k * size,
                        chunk(to_receive.bytes, k, size), in.bytes, nullptr, &in.used);
                    device_->queue.flush();
                });
            });
        }
    }
    for (Staging& out : out_) {
        MPI_Wait(&out.message, MPI_STATUS_IGNORE);
        attempt([&] { wait_for(out.used); });
    }
    for (Staging& in : in_) attempt([&] { wait_for(in.used); });
}

}  // namespace cellist::detail
