#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include <cellist/error.hpp>
#include <cellist/opencl.hpp>

namespace cellist::detail {

/// A read that was enqueued. When the event has completed, the bytes are in `staged`, or where that
/// is null in `target`.
struct PendingRead {
    cl::Event event = {};
    std::shared_ptr<std::byte> staged = {};
    void* target = nullptr;
    std::size_t bytes = 0;
};

/// Data on its way to host memory. Blocks at the end of its life until the memory is free: declare
/// it after the memory.
class ReadbackFence {
public:
    ReadbackFence() = default;
    ReadbackFence(const ReadbackFence&) = delete;
    ReadbackFence& operator=(const ReadbackFence&) = delete;
    ~ReadbackFence() { settle(); }

    /// Waits for this one too. Events of a queue in order: the last stands for all.
    ReadbackFence& operator=(PendingRead reading) {
        event_ = std::exchange(reading.event, {});
        if (reading.staged) staged_.push_back(std::move(reading));
        return *this;
    }
    /// The event that completes when wait() has nothing to wait for. Not a copy by the bindings:
    /// those throw an error of their own.
    [[nodiscard]] cl::Event event() const {
        const cl_int code = event_() == nullptr ? CL_SUCCESS : clRetainEvent(event_());
        if (code != CL_SUCCESS) throw OpenClError("clRetainEvent", code);
        return cl::Event(event_());
    }

    /// Blocks until all has arrived where it was to go.
    void wait() {
        if (event_() == nullptr) return;
        const cl_int code = clWaitForEvents(1, &event_());
        if (code != CL_SUCCESS) throw OpenClError("clWaitForEvents", code);
        event_ = cl::Event();
        for (const PendingRead& reading : staged_)
            std::memcpy(reading.target, reading.staged.get(), reading.bytes);
        staged_.clear();
    }
    /// The same where nobody asks for the data any more. A wait that fails is tried again; a device
    /// that cannot be waited for twice is taken for lost, and not to write any more.
    void settle() noexcept {
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
