// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <utility>

#include <cellist/error.hpp>
#include <cellist/opencl.hpp>

namespace cellist {

/// A result of type T that the device is still computing. You may destroy the Lists or Buffer
/// object that returned it before get(). Movable, not copyable.
template <class T>
class Pending {
public:
    /// Waits for nothing; get() throws Error.
    Pending() = default;
    /// @private
    Pending(cl::Event event, std::function<T()> result)
        : event_(std::move(event)), result_(std::move(result)) {}
    Pending(Pending&&) noexcept = default;
    Pending& operator=(Pending&&) noexcept = default;
    Pending(const Pending&) = delete;
    Pending& operator=(const Pending&) = delete;
    ~Pending() = default;

    /// Completes when the device has finished the enqueued work.
    [[nodiscard]] const cl::Event& event() const { return event_; }

    /// Returns true if the device has finished the enqueued work. Throws OpenClError. Does not
    /// block.
    [[nodiscard]] bool ready() const {
        if (event_() == nullptr) return true;
        cl_int status = CL_QUEUED;
        const cl_int code = clGetEventInfo(event_(), CL_EVENT_COMMAND_EXECUTION_STATUS,
                                           sizeof status, &status, nullptr);
        if (code != CL_SUCCESS) throw OpenClError("clGetEventInfo", code);
        return status <= CL_COMPLETE;
    }

    /// Returns the result, once. Throws what the blocking call throws, and Error the second time.
    /// Blocks.
    T get() {
        const std::function<T()> result = std::exchange(result_, nullptr);
        if (!result) throw Error("there is no result: it was taken already, or none was asked for");
        return result();
    }

private:
    cl::Event event_;
    std::function<T()> result_;
};

}  // namespace cellist
