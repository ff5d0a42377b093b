// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/opencl.hpp>

namespace cellist::detail {

struct DeviceState;

/// A device, and the total size of the memory that one owner has on it.
class CELLIST_API MemoryOwner {
public:
    explicit MemoryOwner(std::shared_ptr<DeviceState> state) : state_(std::move(state)) {}

    [[nodiscard]] const std::shared_ptr<DeviceState>& state() const { return state_; }
    operator const std::shared_ptr<DeviceState>&() const { return state_; }
    DeviceState* operator->() const { return state_.get(); }
    DeviceState& operator*() const { return *state_; }

    /// Size of the memory that this owner has now.
    [[nodiscard]] std::uint64_t bytes() const { return *bytes_; }

private:
    friend class Memory;

    std::shared_ptr<DeviceState> state_;
    std::shared_ptr<std::atomic<std::uint64_t>> bytes_ =
        std::make_shared<std::atomic<std::uint64_t>>(0);
};

[[noreturn]] CELLIST_API void throw_no_host_memory(std::uint64_t count, std::size_t element_bytes);

/// Host memory for the elements of a result. Throws MemoryError if there is not enough.
template <class T>
[[nodiscard]] std::vector<T> host_memory(std::uint64_t count) {
    try {
        return std::vector<T>(count);
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {}
    throw_no_host_memory(count, sizeof(T));
}

/// A buffer on a device with checked sizes and one way to fail. Never empty for OpenCL: 0 elements
/// take one byte.
class CELLIST_API Memory {
public:
    Memory() = default;
    /// `count` elements of `element_bytes`. Throws MemoryError beyond the device's limit, naming
    /// `what`, and OpenClError if there is no memory; some drivers of GPUs tell so only at the
    /// first use.
    Memory(std::shared_ptr<DeviceState> state, std::uint64_t count, std::size_t element_bytes,
           const char* what = "buffer");
    /// The same; its size counts towards the owner's total while the memory exists.
    Memory(const MemoryOwner& owner, std::uint64_t count, std::size_t element_bytes,
           const char* what)
        : Memory(owner.state_, count, element_bytes, what) {
        share_ = Share(owner.bytes_, size_bytes_);
    }

    Memory(Memory&&) noexcept = default;
    Memory& operator=(Memory&&) noexcept = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory() = default;

    [[nodiscard]] const cl::Buffer& cl() const { return buffer_; }
    /// Throws Error if the memory was moved from.
    [[nodiscard]] const std::shared_ptr<DeviceState>& device() const { return state_.pointer(); }
    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }

    /// Copies from the host. Blocks.
    void write(const void* source, std::size_t bytes, std::uint64_t at_byte = 0);
    /// Copies to the host. Blocks.
    void read(void* target, std::size_t bytes, std::uint64_t from_byte = 0) const;
    /// The same without blocking. `source` stays until the event has completed, `target` until the
    /// reading has arrived.
    cl::Event write_later(const void* source, std::size_t bytes, std::uint64_t at_byte = 0);
    [[nodiscard]] PendingRead read_later(void* target, std::size_t bytes,
                                         std::uint64_t from_byte = 0) const;
    /// Repeats a pattern over the first `bytes`. If the pattern's size is not a power of two up to
    /// 128, blocks, and throws MemoryError if the host has no memory for the copies.
    void fill(const void* pattern, std::size_t pattern_bytes, std::size_t bytes);

private:
    /// A part of an owner's total.
    class Share {
    public:
        Share() = default;
        Share(std::shared_ptr<std::atomic<std::uint64_t>> sum, std::uint64_t bytes)
            : sum_(std::move(sum)), bytes_(bytes) {
            *sum_ += bytes_;
        }
        Share(Share&& other) noexcept { *this = std::move(other); }
        Share& operator=(Share&& other) noexcept {
            std::swap(sum_, other.sum_);
            std::swap(bytes_, other.bytes_);
            return *this;
        }
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;
        ~Share() {
            if (sum_) *sum_ -= bytes_;
        }

    private:
        std::shared_ptr<std::atomic<std::uint64_t>> sum_;
        std::uint64_t bytes_ = 0;
    };

    Owned<std::shared_ptr<DeviceState>> state_{"a Buffer"};
    cl::Buffer buffer_;
    std::uint64_t size_bytes_ = 0;
    Share share_;
};

}  // namespace cellist::detail
