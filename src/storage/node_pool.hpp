// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

#include "device/device_state.hpp"
#include "device/view.hpp"

namespace cellist::detail {

/// The counters of a pool as they were when they were read.
class CELLIST_API Counters {
public:
    struct Sum {
        std::uint64_t allocated = 0;  ///< nodes that are left in per-thread blocks count as free
        std::uint64_t end = 0;        ///< no address from here on is allocated
        std::uint64_t dropped = 0;
        std::uint64_t rejected = 0;
        std::uint64_t late = 0;
    };
    [[nodiscard]] Sum sum() const;

private:
    friend class NodePool;

    std::vector<cellist_shard> elements_;  ///< shards, then per-thread blocks, then threads
    std::size_t shard_elements_ = 0;       ///< the shards and the pool's state
    cl_uint thread_slots_ = 0;
};

/// The memory of a storage: heads, nodes and counters (allocation.clh), within the budget. The pool
/// grows by the overflow policy.
class CELLIST_API NodePool {
public:
    struct Layout {
        std::size_t node_bytes;
        std::uint64_t head_words_a_cell;
        std::uint64_t more_head_words = 0;
        bool is_linked = false;  ///< heads move with the nodes, and threads may have blocks
    };

    /// The heads alone; `container` owns what counts towards the same budget. Throws Error if a
    /// size exceeds a limit.
    NodePool(const MemoryOwner& container, const Shape& shape, const ListsOptions& options,
             const Layout& layout);

    /// Owns all that the storage keeps.
    [[nodiscard]] const MemoryOwner& owner() const { return device_; }
    [[nodiscard]] std::uint64_t bytes() const { return device_.bytes(); }
    [[nodiscard]] bool has_budget() const {
        return budget_bytes_ != std::numeric_limits<std::uint64_t>::max();
    }
    /// Whether the budget and the device allow for a storage of this size.
    [[nodiscard]] bool allows(std::uint64_t all_bytes) const;
    [[nodiscard]] bool has_room_for(std::uint64_t more_bytes) const {
        return allows(bytes() + more_bytes);
    }

    // ---- capacity

    /// How many records surely fit.
    [[nodiscard]] std::uint64_t capacity_nodes() const { return capacity_nodes_; }
    /// Nodes there are; more than the capacity where threads have blocks.
    [[nodiscard]] std::uint64_t nodes_count() const {
        return capacity_nodes_ + std::uint64_t{thread_slots_} * CELLIST_BLOCK_NODES;
    }
    [[nodiscard]] std::size_t node_bytes() const { return layout_.node_bytes; }
    [[nodiscard]] cl_uint shard_bits() const { return shard_bits_; }
    [[nodiscard]] cl_uint thread_slots() const { return thread_slots_; }
    /// The most nodes that the policy lets the pool have.
    [[nodiscard]] std::uint64_t most_nodes() const;
    /// Memory of the same owner that goes when the pool is replaced.
    void set_replaceable_bytes(std::uint64_t bytes) { replaceable_bytes_ = bytes; }

    /// Why the pool cannot have this capacity, if it cannot.
    [[nodiscard]] std::optional<std::string> refusal(std::uint64_t capacity_nodes) const;
    /// The memory of the storage with this capacity.
    [[nodiscard]] std::uint64_t bytes_with(std::uint64_t capacity_nodes) const;
    /// Throws OverflowError if the policy or a limit forbids a pool of `demand` nodes.
    void require(std::uint64_t demand, const BuildReport& report) const;

    /// Makes a pool of this capacity; the nodes of the old one are gone. Throws Error.
    void allocate(std::uint64_t capacity_nodes);
    /// The same for a slice of so many cells. Throws OverflowError if a limit forbids it.
    void allocate_for_slice(std::uint64_t capacity_nodes, std::uint64_t cells);
    /// The same for what a build demands. Throws OverflowError where builds demand more in every
    /// pass: the kernel does not repeat itself.
    void grow(std::uint64_t capacity_nodes, const BuildReport& report);
    /// A build begins: it may grow the pool a number of times.
    void start_build() { growths_ = 0; }

    /// Gives the nodes' memory back.
    void release() noexcept;
    /// Makes a pool again after a failed build. A pool that grows starts at 0 nodes if it has none,
    /// or if `without_pool` is true. Other pools get back what release() took.
    void recover(bool without_pool);

    // ---- buffers

    [[nodiscard]] const Memory& heads() const { return heads_; }
    [[nodiscard]] const Memory& nodes() const { return nodes_; }
    [[nodiscard]] const Memory& counters() const { return counters_; }
    /// Elements of the buffer of counters; threads and their blocks are among them.
    [[nodiscard]] std::uint64_t counter_elements() const {
        return counters_.size_bytes() / sizeof(cellist_shard);
    }
    void replace_heads(Memory heads) { heads_ = std::move(heads); }

    /// Memory for as many nodes as the pool has, and for their heads where lists are linked.
    struct BackBuffer {
        Memory nodes;
        Memory heads;
    };
    /// Makes it the first time, and keeps it as long as the pool. Null where the budget or the
    /// device has no room for it.
    [[nodiscard]] const BackBuffer* back_buffer();
    /// Swaps the nodes and heads with those of the back buffer: linked lists have moved, and
    /// nothing else is in the pool.
    void swap_back_buffer() noexcept;

    /// Sets words of heads, the pool's or others, and clears all counters. Does not block.
    void clear(const Memory& heads, cl_uint head, std::uint64_t first_word, std::uint64_t words);
    /// Sets words of the heads. Does not block.
    void fill_heads(cl_uint value, std::uint64_t first_word, std::uint64_t words);
    /// Enqueues the reading of the counters: they are there when it has arrived.
    [[nodiscard]] PendingRead read(Counters& counters) const;
    /// Enqueues the reading of the late inserts since the last clear(): low and high word.
    [[nodiscard]] PendingRead read_late_inserts(std::array<cl_uint, 2>& words) const;

private:
    [[nodiscard]] cl_uint thread_slots_with(std::uint64_t capacity_nodes) const;
    [[nodiscard]] std::size_t shard_elements() const { return (std::size_t{1} << shard_bits_) + 1; }

    MemoryOwner device_;
    MemoryOwner container_;
    Shape shape_;
    Overflow overflow_;
    std::uint64_t budget_bytes_;
    Layout layout_;
    std::uint64_t capacity_nodes_ = 0;
    cl_uint shard_bits_ = 0;
    cl_uint thread_slots_ = 0;
    std::optional<std::uint64_t> released_nodes_;  ///< the capacity that release() gave back
    std::uint64_t replaceable_bytes_ = 0;
    std::uint32_t growths_ = 0;  ///< of this build
    Memory heads_;
    Memory nodes_;
    Memory counters_;
    std::optional<BackBuffer> back_buffer_;
    std::optional<Kernel> clear_;
};

}  // namespace cellist::detail
