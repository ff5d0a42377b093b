#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <cellist/detail/arrival.hpp>
#include <cellist/opencl.hpp>

namespace cellist::detail {

struct DeviceState;

/// A buffer on a device with checked sizes and one way to fail. Never empty for OpenCL: 0 elements
/// take one byte.
class Memory {
public:
    Memory() = default;
    /// `count` elements of `element_bytes`. Throws Error beyond the device's limit, naming `what`, and
    /// OpenClError where there is no memory; some drivers of GPUs tell so only at the first use.
    Memory(std::shared_ptr<DeviceState> state, std::uint64_t count, std::size_t element_bytes,
           const char* what = "buffer");

    Memory(Memory&&) noexcept = default;
    Memory& operator=(Memory&&) noexcept = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory() = default;

    [[nodiscard]] const cl::Buffer& cl() const { return buffer_; }
    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }

    /// Copies from the host. Blocks.
    void write(const void* source, std::size_t bytes);
    /// Copies to the host. Blocks.
    void read(void* target, std::size_t bytes) const;
    /// The same without blocking. `source` stays until the event has completed, `target` until the
    /// reading has arrived.
    cl::Event write_later(const void* source, std::size_t bytes);
    [[nodiscard]] Reading read_later(void* target, std::size_t bytes) const;
    /// Repeats a pattern over the first `bytes`. Blocks only where the pattern's size is no power of
    /// two up to 128.
    void fill(const void* pattern, std::size_t pattern_bytes, std::size_t bytes);

private:
    std::shared_ptr<DeviceState> state_;
    cl::Buffer buffer_;
    std::uint64_t size_bytes_ = 0;
};

}  // namespace cellist::detail
