// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include <cellist/opencl.hpp>

namespace cellist::detail {

/// Page-locked host memory of a device, in blocks, through which small reads go: docs/adr/017.
class PinnedStaging : public std::enable_shared_from_this<PinnedStaging> {
public:
    /// Holds the counters of any pool on a GPU: see node_pool.cpp.
    static constexpr std::size_t block_bytes = 20480;

    PinnedStaging(cl::Context context, cl::CommandQueue queue)
        : context_(std::move(context)), queue_(std::move(queue)) {}
    PinnedStaging(const PinnedStaging&) = delete;
    PinnedStaging& operator=(const PinnedStaging&) = delete;
    ~PinnedStaging();

    /// A block that is nobody else's until the last copy of the pointer has gone, for commands of
    /// the queue. Any thread may call it. Does not block.
    [[nodiscard]] std::shared_ptr<std::byte> block();

private:
    struct Block {
        cl::Buffer memory;
        void* bytes = nullptr;
    };
    [[nodiscard]] Block take();

    cl::Context context_;
    cl::CommandQueue queue_;
    std::mutex mutex_;
    std::vector<Block> free_;  ///< with room for all blocks
    std::size_t made_ = 0;
};

}  // namespace cellist::detail
