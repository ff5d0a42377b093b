// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include <cellist/detail/memory.hpp>

#include "device/device_state.hpp"

namespace cellist::detail {

void throw_no_host_memory(std::uint64_t count, std::size_t element_bytes) {
    throw MemoryError("the host has no memory for a result of " + std::to_string(count) +
                      " elements of " + std::to_string(element_bytes) + " bytes");
}

Memory::Memory(std::shared_ptr<DeviceState> state, std::uint64_t count, std::size_t element_bytes,
               const char* what)
    : state_("a Buffer", std::move(state)) {
    const std::uint64_t limit = state_->info.max_allocation_bytes;
    if (count > limit / element_bytes)
        throw MemoryError(std::string(what) + " of " + std::to_string(count) + " elements of " +
                          std::to_string(element_bytes) + " bytes exceeds this device's limit of " +
                          std::to_string(limit) + " bytes per allocation");
    size_bytes_ = count * element_bytes;
    // PoCL looks for memory at a buffer's first use, and aborts where there is none, unless it is
    // asked to at once.
    cl_mem_flags flags = CL_MEM_READ_WRITE;
    if ((state_->info.type & CL_DEVICE_TYPE_CPU) != 0) flags |= CL_MEM_ALLOC_HOST_PTR;
    opencl([&] {
        buffer_ = cl::Buffer(state_->context, flags, std::max<std::uint64_t>(size_bytes_, 1));
    });
}

void Memory::write(const void* source, std::size_t bytes, std::uint64_t at_byte) {
    if (bytes == 0) return;
    opencl([&] {
        state_->ordered_queue().enqueueWriteBuffer(buffer_, CL_TRUE, at_byte, bytes, source);
    });
}

void Memory::read(void* target, std::size_t bytes, std::uint64_t from_byte) const {
    ReadbackFence fence;
    fence.add(read_later(target, bytes, from_byte));
    fence.wait();
}

cl::Event Memory::write_later(const void* source, std::size_t bytes, std::uint64_t at_byte) {
    if (bytes == 0) return state_->enqueue_marker();
    return opencl([&] {
        cl::Event event;
        state_->ordered_queue().enqueueWriteBuffer(buffer_, CL_FALSE, at_byte, bytes, source,
                                                   nullptr, &event);
        return event;
    });
}

PendingRead Memory::read_later(void* target, std::size_t bytes, std::uint64_t from_byte) const {
    if (bytes == 0) return {.event = state_->enqueue_marker()};
    PendingRead reading{.target = target, .bytes = bytes};
    if (bytes <= PinnedStaging::block_bytes) reading.staged = state_->staging->block();
    void* const to = reading.staged ? reading.staged.get() : target;
    opencl([&] {
        state_->ordered_queue().enqueueReadBuffer(buffer_, CL_FALSE, from_byte, bytes, to, nullptr,
                                                  &reading.event);
    });
    return reading;
}

void Memory::fill(const void* pattern, std::size_t pattern_bytes, std::size_t bytes) {
    if (bytes == 0) return;
    if (std::has_single_bit(pattern_bytes) && pattern_bytes <= 128) {
        // The C++ bindings take the pattern as a type, not as bytes.
        check("clEnqueueFillBuffer",
              clEnqueueFillBuffer(state_->ordered_queue()(), buffer_(), pattern, pattern_bytes, 0,
                                  bytes, 0, nullptr, nullptr));
        return;
    }
    auto copies = host_memory<std::byte>(bytes);
    for (std::size_t at = 0; at < bytes; at += pattern_bytes)
        std::memcpy(copies.data() + at, pattern, std::min(pattern_bytes, bytes - at));
    write(copies.data(), bytes);
}

}  // namespace cellist::detail
