// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/error.hpp>
#include <cellist/opencl.hpp>

namespace cellist::detail {

/// A read that was enqueued. When the event has completed, the bytes are in `staged`, or where that
/// is null in `target`.
struct CELLIST_API PendingRead {
    cl::Event event = {};
    std::shared_ptr<std::byte> staged = {};
    void* target = nullptr;
    std::size_t bytes = 0;
};

/// Reads into host memory that are under way. The destructor blocks until no read writes to the
/// memory: declare the fence after the memory.
class CELLIST_API ReadbackFence {
public:
    ReadbackFence() = default;
    ReadbackFence(const ReadbackFence&) = delete;
    ReadbackFence& operator=(const ReadbackFence&) = delete;
    ~ReadbackFence() { wait_quietly(); }

    /// Adds a read to those that wait() waits for. The reads of a fence complete in order, so the
    /// event of the last read stands for all.
    void add(PendingRead reading) {
        event_ = std::exchange(reading.event, {});
        if (reading.staged) staged_.push_back(std::move(reading));
    }
    /// The event that completes when wait() has nothing to wait for. Not a copy by the bindings:
    /// those throw an error of their own.
    [[nodiscard]] cl::Event event() const {
        const cl_int code = event_() == nullptr ? CL_SUCCESS : clRetainEvent(event_());
        if (code != CL_SUCCESS) throw OpenClError("clRetainEvent", code);
        return cl::Event(event_());
    }

    /// Blocks until the targets of all reads have their data.
    void wait() {
        if (event_() == nullptr) return;
        const cl_int code = clWaitForEvents(1, &event_());
        if (code != CL_SUCCESS) throw OpenClError("clWaitForEvents", code);
        event_ = cl::Event();
        for (const PendingRead& reading : staged_)
            std::memcpy(reading.target, reading.staged.get(), reading.bytes);
        staged_.clear();
    }
    /// Waits, and discards the data. Tries again if the wait fails. If it fails twice, the device
    /// counts as lost and writes no more.
    void wait_quietly() noexcept {
        if (event_() == nullptr) return;
        if (clWaitForEvents(1, &event_()) != CL_SUCCESS) clWaitForEvents(1, &event_());
        event_ = cl::Event();
        staged_.clear();
    }

private:
    cl::Event event_;
    std::vector<PendingRead> staged_;
};

}  // namespace cellist::detail
