// SPDX-License-Identifier: MIT
#include "device/pinned_staging.hpp"

#include <utility>

#include "device/device_state.hpp"

namespace cellist::detail {

PinnedStaging::~PinnedStaging() {
    for (const Block& block : free_)
        clEnqueueUnmapMemObject(queue_(), block.memory(), block.bytes, 0, nullptr, nullptr);
}

std::shared_ptr<std::byte> PinnedStaging::block() {
    Block block = take();
    auto* const bytes = static_cast<std::byte*>(block.bytes);
    return {bytes, [self = shared_from_this(), block = std::move(block)](std::byte*) mutable {
                const std::lock_guard lock(self->mutex_);
                self->free_.push_back(std::move(block));
            }};
}

PinnedStaging::Block PinnedStaging::take() {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
        Block block = std::move(free_.back());
        free_.pop_back();
        return block;
    }
    free_.reserve(made_ + 1);
    ++made_;
    return opencl([&] {
        Block block;
        block.memory = cl::Buffer(context_, CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, block_bytes);
        // Whatever uses the block is enqueued after the mapping.
        block.bytes = queue_.enqueueMapBuffer(block.memory, CL_FALSE, CL_MAP_READ | CL_MAP_WRITE, 0,
                                              block_bytes);
        return block;
    });
}

}  // namespace cellist::detail
