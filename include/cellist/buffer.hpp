// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/device.hpp>
#include <cellist/error.hpp>
#include <cellist/pending.hpp>

namespace cellist {

/// `size()` elements of T in device memory. T must have the layout that the kernels expect.
/// Movable, not copyable. Using a moved-from buffer throws Error. Every function that uses the
/// device throws OpenClError if an OpenCL call fails.
template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>, "a Buffer holds trivially copyable elements");

public:
    /// No buffer yet: as if moved from.
    Buffer() = default;

    /// Allocates `size` uninitialised elements. Throws MemoryError if they exceed the device's
    /// largest allocation.
    Buffer(const Device& device, std::size_t size) : Buffer(device.state(), size) {}

    /// Allocates a copy of `elements`. Throws MemoryError as above. Blocks until the copy is
    /// complete.
    Buffer(const Device& device, std::span<const T> elements) : Buffer(device, elements.size()) {
        memory_.write(elements.data(), elements.size_bytes());
    }
    Buffer(const Device& device, const std::vector<T>& elements)
        : Buffer(device, std::span<const T>(elements)) {}

    [[nodiscard]] std::size_t size() const { return memory().size_bytes() / sizeof(T); }
    [[nodiscard]] const cl::Buffer& cl() const { return memory().cl(); }

    /// Returns a copy of the elements, after all work that was enqueued before. Throws MemoryError
    /// if the host has no memory for it. Blocks.
    [[nodiscard]] std::vector<T> download() const { return download(0, size()); }
    /// Returns a copy of `count` elements, from the element `first` on. Throws Error if the buffer
    /// ends before. Otherwise like download().
    [[nodiscard]] std::vector<T> download(std::size_t first, std::size_t count) const {
        require_inside(first, count);
        std::vector<T> elements = detail::host_memory<T>(count);
        memory_.read(elements.data(), count * sizeof(T), first * sizeof(T));
        return elements;
    }

    /// Like download(), but does not block.
    [[nodiscard]] Pending<std::vector<T>> download_async() const {
        return download_async(0, size());
    }
    [[nodiscard]] Pending<std::vector<T>> download_async(std::size_t first,
                                                         std::size_t count) const {
        require_inside(first, count);
        struct State {
            std::vector<T> elements;
            detail::ReadbackFence done;
        };
        const auto state = std::make_shared<State>();
        state->elements = detail::host_memory<T>(count);
        state->done.add(
            memory_.read_later(state->elements.data(), count * sizeof(T), first * sizeof(T)));
        return {state->done.event(), [state] {
                    state->done.wait();
                    return std::move(state->elements);
                }};
    }

    /// Copies `elements` to the buffer, from the element `first` on, after all work that was
    /// enqueued before. Throws Error if the buffer ends before. Blocks until the copy is complete.
    void upload(std::span<const T> elements, std::size_t first = 0) {
        require_inside(first, elements.size());
        memory_.write(elements.data(), elements.size_bytes(), first * sizeof(T));
    }

    /// Like upload(), but does not block. Keep the elements unchanged until the event completes.
    cl::Event upload_async(std::span<const T> elements, std::size_t first = 0) {
        require_inside(first, elements.size());
        return memory_.write_later(elements.data(), elements.size_bytes(), first * sizeof(T));
    }

    /// Sets every element to `value`. Does not block if sizeof(T) is a power of two up to 128. For
    /// other sizes, throws MemoryError if the host has no memory for a copy of the elements.
    void fill(const T& value) { memory_.fill(&value, sizeof(T), size() * sizeof(T)); }

    /// @private
    Buffer(const std::shared_ptr<detail::DeviceState>& device, std::size_t size)
        : memory_(device, size, sizeof(T)) {}
    /// @private Allocates anew unless there is room for `size` elements.
    void reserve(const std::shared_ptr<detail::DeviceState>& device, std::size_t size) {
        if (memory_.cl()() == nullptr || memory_.size_bytes() < size * sizeof(T) ||
            memory_.device() != device)
            *this = Buffer(device, size);
    }
    /// @private
    [[nodiscard]] const detail::Memory& memory() const {
        (void)memory_.device();  // throws if it was moved from
        return memory_;
    }

private:
    void require_inside(std::size_t first, std::size_t count) const {
        if (first > size() || count > size() - first)
            throw Error("a buffer of " + std::to_string(size()) + " elements has no " +
                        std::to_string(count) + " elements from element " + std::to_string(first) +
                        " on");
    }

    detail::Memory memory_;
};

}  // namespace cellist
