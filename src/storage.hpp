#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

#include "device_state.hpp"
#include "record_kernels.hpp"
#include "view.hpp"

namespace cellist::detail {

/// The kernel did not insert the same records again where that is needed.
class UnrepeatableError : public Error {
public:
    using Error::Error;
};

/// Whether a kernel may insert into a container.
enum class Inserts { refused, accepted };

/// How a container keeps its nodes: the buffers, and the passes of a build. One class a storage; the
/// device's side of all of them is kernels/cellist/lists.clh.
class ListStorage {
public:
    virtual ~ListStorage() = default;
    ListStorage(const ListStorage&) = delete;
    ListStorage& operator=(const ListStorage&) = delete;

    /// Empties the lists. Does not block.
    virtual void clear() = 0;

    /// A build is start(), then passes until review() says that the lists are complete; see build.cpp.
    /// More passes may follow, where another container needs them: they fill the lists anew.
    virtual void start();
    /// Enqueues what the next run of the kernels needs. Does not block.
    virtual void begin_pass() { clear(); }
    /// Enqueues what follows a run of the kernels, the reading of its counters above all. True if
    /// another pass must follow that needs no review of this one. Does not block.
    virtual bool end_pass() = 0;
    /// Takes the counters of the last pass into the report, and grows, stops or drops by the options.
    /// True if the lists are complete. Throws OverflowError; the caller empties the lists then. Blocks.
    virtual bool review(BuildReport& report) = 0;
    /// Whether a review can change the lists.
    [[nodiscard]] bool may_grow() const { return options_.overflow != Overflow::drop; }

    /// Blocks until nothing is on its way to this object's memory. Comes before the destructor.
    void settle() noexcept { reading_.settle(); }
    /// Gives the nodes' memory back, before another storage takes this one's place. What is left can
    /// only be destroyed, or be recovered. Blocks as settle() does.
    virtual void release_pool() noexcept;
    /// Makes what a failed build may have left undone, with empty lists. A pool that grows is empty
    /// afterwards if there was none, or if `without_pool` says so.
    void recover(bool without_pool);

    /// Enqueues a check for links, offsets and counts that are inconsistent, or differ from those of the
    /// last build. Does not block. Call the result once, when that build is finished; that call blocks.
    [[nodiscard]] virtual std::function<Validation()> validate() = 0;

    /// From now on, these cells alone have lists. The lists must be empty.
    virtual void set_slice(const Slice& slice) { slice_ = slice; }
    /// Nodes that lists need in so many cells, the longest of them as long, `total` together.
    [[nodiscard]] virtual std::uint64_t nodes_for(std::uint64_t total, std::uint64_t longest,
                                                  std::uint64_t cells) const = 0;
    /// The most nodes that the policy lets the pool have.
    [[nodiscard]] std::uint64_t most_nodes() const;
    /// Makes room for such lists in the slice, if the policy is to grow. Throws OverflowError.
    virtual void reserve(std::uint64_t total, std::uint64_t longest) = 0;

    /// Enqueues the reading of the inserts since the last clear() that were refused for there was no
    /// build: low and high word.
    [[nodiscard]] PendingRead read_late(std::array<cl_uint, 2>& words) const;

    /// Adds what CELLIST_LISTS declares.
    virtual void add_to(Arguments& arguments, Inserts inserts = Inserts::refused) const;

    /// Records that surely fit.
    [[nodiscard]] std::uint64_t capacity_nodes() const { return capacity_nodes_; }
    /// Nodes there are; more than that where threads have some in their thread_slots.
    [[nodiscard]] std::uint64_t pool_nodes() const { return pool_nodes_with(capacity_nodes_); }
    /// Elements of the counters, thread_slots of threads included.
    [[nodiscard]] std::uint64_t counters() const { return counters_with(capacity_nodes_); }
    /// Device memory of all buffers that the storage keeps.
    [[nodiscard]] std::uint64_t bytes() const { return device_.bytes(); }
    /// Whether the budget and the device allow for so much.
    [[nodiscard]] bool has_room_for(std::uint64_t all_bytes) const {
        return all_bytes <= std::min(options_.budget_bytes, device_->info.global_memory_bytes);
    }
    [[nodiscard]] std::uint64_t cells() const { return shape_.cells(); }
    [[nodiscard]] Storage kind() const { return options_.storage; }
    [[nodiscard]] const cl::Buffer& nodes() const { return nodes_.cl(); }

    /// Memory for as many nodes as the pool has, and for their heads where lists are linked.
    struct BackBuffer {
        Memory nodes;
        Memory heads;
    };
    /// Makes it the first time, and keeps it as long as the pool. Null where the budget or the device
    /// has no room for it.
    [[nodiscard]] const BackBuffer* back_buffer();
    /// The back_buffer nodes and heads take the place of the pool's, and these become back_buffer: linked lists have
    /// moved, and nothing else is in the pool.
    void swap_back_buffer() noexcept;
    /// The mode in which the lists are read.
    [[nodiscard]] cl_uint mode() const { return mode_; }
    /// Records in the lists.
    [[nodiscard]] std::uint64_t stored() const { return expected_->stored; }

protected:
    struct Counters {
        std::uint64_t allocated = 0;
        std::uint64_t dropped = 0;
        std::uint64_t rejected = 0;
        std::uint64_t late = 0;
    };
    using Shards = std::vector<cellist_shard>;

    ListStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options,
                cl_uint mode, std::size_t node_bytes, std::uint64_t head_words_a_cell,
                std::uint64_t more_head_words = 0);

    virtual void make_whole(bool without_pool) = 0;

    /// What kernels see of the container.
    [[nodiscard]] cellist_view view(Inserts inserts) const;
    void add_to(Arguments& arguments, const Memory& nodes, const Memory& heads,
                const cellist_view& view) const;
    [[nodiscard]] const RecordType& record() const { return kernels_.record(); }
    [[nodiscard]] std::uint64_t pool_nodes_with(std::uint64_t capacity_nodes) const;
    /// Elements of the counters, thread_slots and their owners included.
    [[nodiscard]] std::uint64_t counters_with(std::uint64_t capacity_nodes) const;
    [[nodiscard]] std::uint64_t bytes_with(std::uint64_t capacity_nodes) const;
    /// Device memory of the buffers that another pool would replace.
    [[nodiscard]] virtual std::uint64_t replaceable_bytes() const;
    /// Why the pool cannot have this capacity, if it cannot.
    [[nodiscard]] std::optional<std::string> refusal(std::uint64_t capacity_nodes) const;
    /// Makes a pool of this capacity; the nodes of the old one are gone. Throws Error.
    void allocate_pool(std::uint64_t capacity_nodes);
    /// Whether recover() leaves an empty pool. Under other policies than to grow, the pool stays the one
    /// of the options, so that later builds hold as much.
    [[nodiscard]] bool empties_pool(bool without_pool) const {
        return options_.overflow == Overflow::grow && (without_pool || nodes_.cl()() == nullptr);
    }
    /// allocate_pool() for a slice. Throws OverflowError if a limit forbids it.
    void make_pool(std::uint64_t capacity_nodes);
    /// allocate_pool() for what a build demands. Throws OverflowError where builds demand more in every
    /// pass: the kernel does not repeat itself.
    void grow_pool(std::uint64_t capacity_nodes, const BuildReport& report);
    /// Enqueues the reading of the counters: they are there when it has arrived.
    [[nodiscard]] PendingRead read_counters(Shards& shards) const;
    /// Of counters that are followed by so many thread_slots. What is in these counts as free.
    [[nodiscard]] static Counters sum(const Shards& shards, cl_uint thread_slots);
    /// The thread_slots of threads with a pool of this capacity: see threads.clh.
    [[nodiscard]] virtual cl_uint thread_slots_with(std::uint64_t) const { return 0; }
    /// Sets words of heads, and clears all counters. Does not block.
    void clear_heads_and_counters(const Memory& heads, cl_uint head, std::uint64_t first_word,
                                  std::uint64_t words);
    void clear_heads_and_counters(cl_uint head, std::uint64_t first_word, std::uint64_t words) {
        clear_heads_and_counters(heads_, head, first_word, words);
    }
    /// Sets words of the heads. Does not block.
    void fill_heads(cl_uint value, std::uint64_t first_word, std::uint64_t words);
    /// A report of the counters.
    void update(BuildReport& report, const Counters& counters, std::uint64_t stored);
    /// Throws OverflowError if the policy or a limit forbids a pool of `demand` nodes.
    void require(std::uint64_t demand, const BuildReport& report) const;

    /// The state after a build, for a validation to compare with.
    struct Expected {
        std::uint64_t stored = 0;
        std::uint64_t counts_hash = 0;
    };
    /// Nothing is in the lists any more, and a build may follow.
    void expect_nothing() { expected_ = std::make_shared<Expected>(); }

    /// What a validating kernel finds, on its way to the host.
    struct Findings {
        Memory memory;
        cellist_findings found{};
    };
    [[nodiscard]] Memory memory_for_findings() const {
        return {device_.state(), 1, sizeof(cellist_findings), "findings"};
    }
    /// Enqueues a validating kernel over all cells: (container, arguments..., findings). What it found
    /// is there when the reading has arrived.
    [[nodiscard]] PendingRead find(Findings& findings, Kernel& kernel,
                                   const Arguments& arguments) const;

    MemoryOwner device_;
    RecordKernels& kernels_;
    Shape shape_;
    ListsOptions options_;
    cl_uint mode_;
    std::size_t node_bytes_;
    std::uint64_t capacity_nodes_ = 0;
    std::optional<std::uint64_t> released_nodes_;  ///< the capacity that release_pool() gave back
    std::shared_ptr<Expected> expected_ = std::make_shared<Expected>();  ///< of the last build
    cl_uint shard_bits_ = 0;
    cl_uint slots_ = 0;
    cl_uint key_member_ = 0;
    cl_uint threshold_words_ = 0;
    std::uint32_t growths_ = 0;  ///< of this build
    Slice slice_;
    Memory heads_;
    Memory nodes_;
    Memory shards_;
    std::optional<BackBuffer> back_buffer_;
    std::optional<Kernel> clear_;
    Shards counters_;        ///< of the last pass
    ReadbackFence reading_;  ///< what a review waits for: the last reading of the pass
};

/// The lowest bad cell, if there is one.
[[nodiscard]] inline std::optional<std::uint64_t> bad_cell(const cellist_findings& findings) {
    if (findings.bad_cell_from_end == 0) return {};
    return CELLIST_NONE - findings.bad_cell_from_end;
}

/// The storage that the options name, with empty lists. Throws Error if a size exceeds a limit.
[[nodiscard]] std::unique_ptr<ListStorage> make_storage(RecordKernels& kernels, const Shape& shape,
                                                        const ListsOptions& options);

}  // namespace cellist::detail
