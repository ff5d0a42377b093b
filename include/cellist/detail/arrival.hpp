#pragma once

#include <cellist/error.hpp>
#include <cellist/opencl.hpp>

namespace cellist::detail {

/// Data on its way to or from host memory. Blocks at the end of its life until the memory is free:
/// declare it behind the memory.
class Arrival {
public:
    Arrival() = default;
    Arrival(const Arrival&) = delete;
    Arrival& operator=(const Arrival&) = delete;
    ~Arrival() { settle(); }

    /// Waits for this event too. Events of a queue in order: the last stands for all.
    Arrival& operator=(cl::Event event) {
        event_ = std::move(event);
        return *this;
    }
    /// The event that completes when all has arrived. Not a copy by the bindings: those throw an error
    /// of their own.
    [[nodiscard]] cl::Event event() const {
        const cl_int code = event_() == nullptr ? CL_SUCCESS : clRetainEvent(event_());
        if (code != CL_SUCCESS) throw OpenClError("clRetainEvent", code);
        return cl::Event(event_());
    }

    /// Blocks until all has arrived.
    void wait() {
        if (event_() == nullptr) return;
        const cl_int code = clWaitForEvents(1, &event_());
        if (code != CL_SUCCESS) throw OpenClError("clWaitForEvents", code);
        event_ = cl::Event();
    }
    /// The same where nobody asks for the data any more. A wait that fails is tried again; a device that
    /// cannot be waited for twice is taken for lost, and not to write any more.
    void settle() noexcept {
        if (event_() == nullptr) return;
        if (clWaitForEvents(1, &event_()) != CL_SUCCESS) clWaitForEvents(1, &event_());
        event_ = cl::Event();
    }

private:
    cl::Event event_;
};

}  // namespace cellist::detail
