// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <cellist/detail/arguments.hpp>
#include <cellist/opencl.hpp>

#include "device/device_state.hpp"

namespace cellist::detail {

/// The queues, other than the one that a command runs on, whose containers and buffers it uses.
class OtherQueues {
public:
    /// For a command on the queue of `user`.
    OtherQueues(const DeviceState& user, const Arguments& arguments);

    [[nodiscard]] bool empty() const { return owners_.empty(); }
    /// Enqueues the command after all that was enqueued on these queues, and before all that
    /// follows there. Takes and returns its event. Does not block.
    cl::Event run_between(const std::function<cl::Event()>& enqueue) const;

private:
    void let_wait(const cl::Event& done) const;

    const DeviceState& user_;
    std::vector<const DeviceState*> owners_;  ///< one for each queue
};

}  // namespace cellist::detail
