// SPDX-License-Identifier: MIT
#include "device/other_queues.hpp"

#include <algorithm>

namespace cellist::detail {

OtherQueues::OtherQueues(const DeviceState& user, const Arguments& arguments) : user_(user) {
    for (const Arguments::Argument& argument : arguments.list()) {
        const DeviceState* owner = argument.owner;
        if (owner == nullptr || owner->queue() == user.queue()) continue;
        const auto has_queue = [&](const DeviceState* other) {
            return other->queue() == owner->queue();
        };
        if (std::none_of(owners_.begin(), owners_.end(), has_queue)) owners_.push_back(owner);
    }
}

cl::Event OtherQueues::run_between(const std::function<cl::Event()>& enqueue) const {
    std::vector<cl::Event> before;
    for (const DeviceState* owner : owners_) {
        before.push_back(owner->enqueue_marker());
        opencl([&] { owner->queue.flush(); });
    }
    opencl([&] { user_.queue.enqueueBarrierWithWaitList(&before); });
    cl::Event done = enqueue();
    try {
        let_wait(done);
    } catch (...) {
        // The owners' queues do not wait for the command, so this waits for its end.
        clFinish(user_.queue());
        throw;
    }
    return done;
}

void OtherQueues::let_wait(const cl::Event& done) const {
    opencl([&] {
        const std::vector<cl::Event> all{done};
        user_.queue.flush();
        for (const DeviceState* owner : owners_) owner->queue.enqueueBarrierWithWaitList(&all);
    });
}

}  // namespace cellist::detail
