// SPDX-License-Identifier: MIT
#include "storage/node_pool.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>

#include "cellist_kernels.hpp"

namespace cellist::detail {

static_assert(Shape::extent_max == CELLIST_EXTENT_MAX);
static_assert(Shape::cells_max < CELLIST_NONE);
static_assert(sizeof(cellist_thread_block) == sizeof(cellist_shard));
static_assert(((1u << CELLIST_SHARD_BITS_MAX) + 1) * sizeof(cellist_shard) <=
              PinnedStaging::block_bytes);

namespace {

/// Four blocks a shard at least: more shards in a small pool only make the search for the last free
/// nodes longer.
cl_uint shard_bits_for(std::uint64_t capacity_nodes) {
    cl_uint bits = 0;
    while (bits < CELLIST_SHARD_BITS_MAX &&
           (std::uint64_t{4} * CELLIST_BLOCK_NODES << (bits + 1)) <= capacity_nodes)
        ++bits;
    return bits;
}

/// Elements of the buffer of counters: shards, the pool's state, the blocks of threads and the
/// table of threads.
std::uint64_t elements_with(cl_uint shard_bits, cl_uint thread_slots) {
    return (std::uint64_t{1} << shard_bits) + 1 + thread_slots +
           thread_slots * sizeof(cl_ulong) / sizeof(cellist_shard);
}

std::uint64_t nodes_with(std::uint64_t capacity_nodes, cl_uint thread_slots) {
    return capacity_nodes + std::uint64_t{thread_slots} * CELLIST_BLOCK_NODES;
}

/// Per-thread blocks take at most this part of a pool; smaller pools have none.
constexpr std::uint64_t thread_blocks_part = 16;

/// Builds that grow as often as this end with an error.
constexpr std::uint32_t growths_max = 8;

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes (" + std::to_string(bytes >> 20) + " MiB)";
}

}  // namespace

Counters::Sum Counters::sum() const {
    Sum sum;
    std::uint64_t most = 0;
    for (const cellist_shard& shard : std::span(elements_).first(shard_elements_)) {
        sum.allocated += shard.allocated;
        most = std::max<std::uint64_t>(most, shard.allocated);
        sum.dropped += wide(shard.dropped_low, shard.dropped_high);
        sum.rejected += wide(shard.rejected_low, shard.rejected_high);
        sum.late += wide(shard.late_low, shard.late_high);
    }
    // Each round has a block of every shard, and the last element is no shard.
    const std::uint64_t rounds = (most + CELLIST_BLOCK_NODES - 1) / CELLIST_BLOCK_NODES;
    sum.end = rounds * CELLIST_BLOCK_NODES * (shard_elements_ - 1);
    for (const cellist_shard& element :
         std::span(elements_).subspan(shard_elements_, thread_slots_)) {
        const auto block = std::bit_cast<cellist_thread_block>(element);
        sum.allocated -= (block.last - block.node) + (block.end - block.next);
    }
    return sum;
}

NodePool::NodePool(const MemoryOwner& container, const Shape& shape, const ListsOptions& options,
                   const Layout& layout)
    : device_(container.state()),
      container_(container),
      shape_(shape),
      overflow_(options.overflow),
      budget_bytes_(options.budget_bytes),
      layout_(layout) {
    const std::uint64_t allocation = device_->info.max_allocation_bytes;
    const std::uint64_t cell_bytes = layout.head_words_a_cell * sizeof(cl_uint);
    const std::uint64_t more_bytes = layout.more_head_words * sizeof(cl_uint);
    if (cell_bytes > allocation)
        throw MemoryError(std::to_string(cell_bytes) +
                          " bytes of heads for each cell exceed this device's "
                          "limit of " +
                          mebibytes(allocation) + " per allocation: lower slots");
    const std::uint64_t most_cells =
        more_bytes > allocation ? 0 : (allocation - more_bytes) / cell_bytes;
    if (shape.cells() > most_cells)
        throw MemoryError("a shape of " + shape.to_string() +
                          " cells exceeds this device's limit of " + std::to_string(most_cells) +
                          " cells (" + mebibytes(allocation) + " per allocation, " +
                          std::to_string(cell_bytes) + " bytes a cell)");
    const std::uint64_t head_words =
        layout.head_words_a_cell * shape.cells() + layout.more_head_words;
    const std::uint64_t head_bytes = head_words * sizeof(cl_uint);
    if (head_bytes > budget_bytes_)
        throw MemoryError("the heads of a shape of " + shape.to_string() + " cells take " +
                          mebibytes(head_bytes) + ", over the budget of " +
                          mebibytes(budget_bytes_) + ": raise budget_bytes");
    heads_ = Memory(device_, head_words, sizeof(cl_uint), "head buffer");
}

bool NodePool::allows(std::uint64_t all_bytes) const {
    return all_bytes + container_.bytes() <=
           std::min(budget_bytes_, device_->info.global_memory_bytes);
}

/// Where the pool does not grow it holds exactly what the options say: no thread may have free
/// nodes for itself. Nor where that would take more memory than there may be.
cl_uint NodePool::thread_slots_with(std::uint64_t capacity_nodes) const {
    if (!layout_.is_linked || !device_->info.one_thread_per_work_group ||
        overflow_ != Overflow::grow)
        return 0;
    const cl_uint slots = thread_slots_of(device_->info);
    const std::uint64_t nodes = std::uint64_t{slots} * CELLIST_BLOCK_NODES;
    if (thread_blocks_part * nodes > capacity_nodes ||
        capacity_nodes > CELLIST_CAPACITY_NODES_MAX - nodes)
        return 0;
    const std::uint64_t pool_bytes = (capacity_nodes + nodes) * layout_.node_bytes;
    const std::uint64_t elements = (1u << CELLIST_SHARD_BITS_MAX) + 1 + 2 * std::uint64_t{slots};
    const bool fits =
        pool_bytes <= device_->info.max_allocation_bytes &&
        heads_.size_bytes() + container_.bytes() + pool_bytes + elements * sizeof(cellist_shard) <=
            budget_bytes_;
    return fits ? slots : 0;
}

std::uint64_t NodePool::bytes_with(std::uint64_t capacity_nodes) const {
    std::uint64_t replaced = replaceable_bytes_ + nodes_.size_bytes() + counters_.size_bytes();
    if (back_buffer_)
        replaced += back_buffer_->nodes.size_bytes() + back_buffer_->heads.size_bytes();
    const cl_uint slots = thread_slots_with(capacity_nodes);
    return bytes() - replaced + nodes_with(capacity_nodes, slots) * layout_.node_bytes +
           elements_with(shard_bits_for(capacity_nodes), slots) * sizeof(cellist_shard);
}

std::optional<std::string> NodePool::refusal(std::uint64_t capacity_nodes) const {
    const std::uint64_t allocation = device_->info.max_allocation_bytes;
    const std::uint64_t limit =
        std::min<std::uint64_t>(allocation / layout_.node_bytes, CELLIST_CAPACITY_NODES_MAX);
    if (nodes_with(capacity_nodes, thread_slots_with(capacity_nodes)) > limit)
        return "capacity of " + std::to_string(capacity_nodes) + " nodes of " +
               std::to_string(layout_.node_bytes) + " bytes exceeds this device's limit of " +
               std::to_string(limit) + " nodes (" + mebibytes(allocation) +
               " per allocation): use fewer cells or records, or a smaller record";
    const std::uint64_t all_bytes = bytes_with(capacity_nodes) + container_.bytes();
    if (all_bytes > budget_bytes_)
        return "a pool of " + std::to_string(capacity_nodes) + " nodes and " +
               std::to_string(shape_.cells()) + " cells takes " + mebibytes(all_bytes) +
               ", over the budget of " + mebibytes(budget_bytes_) + ": raise budget_bytes";
    return {};
}

std::uint64_t NodePool::most_nodes() const {
    if (overflow_ != Overflow::grow) return capacity_nodes_;
    std::uint64_t fits = 0;
    std::uint64_t too_many = std::uint64_t{CELLIST_CAPACITY_NODES_MAX} + 1;
    while (too_many - fits > 1) {
        const std::uint64_t middle = fits + (too_many - fits) / 2;
        (refusal(middle) ? too_many : fits) = middle;
    }
    return fits;
}

void NodePool::require(std::uint64_t demand, const BuildReport& report) const {
    if (overflow_ == Overflow::stop)
        throw OverflowError("the pool of " + std::to_string(capacity_nodes_) +
                                " nodes is too small for " + std::to_string(demand) +
                                " records: raise capacity_nodes or use Overflow::grow",
                            report);
    if (const auto reason = refusal(demand)) throw OverflowError(*reason, report);
}

void NodePool::allocate(std::uint64_t capacity_nodes) {
    // The old nodes go first, so that the device never holds both pools.
    capacity_nodes_ = 0;
    thread_slots_ = 0;
    nodes_ = Memory();
    back_buffer_.reset();
    const cl_uint bits = shard_bits_for(capacity_nodes);
    const cl_uint slots = thread_slots_with(capacity_nodes);
    counters_ = Memory(device_, elements_with(bits, slots), sizeof(cellist_shard), "counters");
    shard_bits_ = bits;
    nodes_ = Memory(device_, nodes_with(capacity_nodes, slots), layout_.node_bytes, "pool");
    thread_slots_ = slots;
    capacity_nodes_ = capacity_nodes;
}

void NodePool::allocate_for_slice(std::uint64_t capacity_nodes, std::uint64_t cells) {
    if (const auto reason = refusal(capacity_nodes))
        throw OverflowError("a slice of " + std::to_string(cells) + " cells: " + *reason,
                            {.attempted = capacity_nodes, .dropped = capacity_nodes});
    allocate(capacity_nodes);
}

void NodePool::grow(std::uint64_t capacity_nodes, const BuildReport& report) {
    if (++growths_ == growths_max)
        throw OverflowError("the kernel inserted more records in each of " +
                                std::to_string(report.passes) +
                                " passes: it must insert the same records every time",
                            report);
    allocate(capacity_nodes);
}

void NodePool::release() noexcept {
    if (!released_nodes_) released_nodes_ = capacity_nodes_;
    capacity_nodes_ = 0;
    thread_slots_ = 0;
    nodes_ = Memory();
    back_buffer_.reset();
}

void NodePool::recover(bool without_pool) {
    const std::optional<std::uint64_t> released = std::exchange(released_nodes_, std::nullopt);
    if (overflow_ != Overflow::grow) {
        if (released) allocate(*released);
    } else if (without_pool || nodes_.cl()() == nullptr) {
        allocate(0);
    }
}

const NodePool::BackBuffer* NodePool::back_buffer() {
    if (back_buffer_) return &*back_buffer_;
    const std::uint64_t heads = layout_.is_linked ? shape_.cells() : 0;
    if (!has_room_for(nodes_.size_bytes() + heads * sizeof(cl_uint))) return nullptr;
    try {
        BackBuffer made{Memory(device_, nodes_count(), layout_.node_bytes, "second pool"),
                        Memory(device_, heads, sizeof(cl_uint), "second head buffer")};
        // Some drivers find out only at the first use whether they have the memory.
        constexpr cl_uchar zero = 0;
        for (Memory* memory : {&made.nodes, &made.heads})
            memory->fill(&zero, sizeof zero, std::min<std::uint64_t>(memory->size_bytes(), 1));
        back_buffer_ = std::move(made);
    } catch (const OpenClError& error) {
        if (!out_of_memory(error)) throw;
        return nullptr;
    }
    return &*back_buffer_;
}

void NodePool::swap_back_buffer() noexcept {
    std::swap(nodes_, back_buffer_->nodes);
    std::swap(heads_, back_buffer_->heads);
}

void NodePool::clear(const Memory& heads, cl_uint head, std::uint64_t first_word,
                     std::uint64_t words) {
    if (!clear_)
        clear_.emplace(device_,
                       Source{.text = std::string(kernels::clear_cl), .file_name = "clear.cl"},
                       "cellist_clear", Definitions{});
    const std::uint64_t counter_words = counters_.size_bytes() / sizeof(cl_uint);
    Arguments arguments;
    arguments.add(heads.cl());
    arguments.add(cl_ulong{first_word});
    arguments.add(cl_ulong{words});
    arguments.add(head);
    arguments.add(counters_.cl());
    arguments.add(static_cast<cl_uint>(counter_words));
    clear_->enqueue(Range::padded(std::max(words, counter_words)), arguments);
}

void NodePool::fill_heads(cl_uint value, std::uint64_t first_word, std::uint64_t words) {
    if (words == 0) return;
    check(
        "clEnqueueFillBuffer",
        clEnqueueFillBuffer(device_->ordered_queue()(), heads_.cl()(), &value, sizeof value,
                            first_word * sizeof value, words * sizeof value, 0, nullptr, nullptr));
}

PendingRead NodePool::read(Counters& counters) const {
    counters.shard_elements_ = shard_elements();
    counters.thread_slots_ = thread_slots_;
    counters.elements_.resize(counter_elements());
    return counters_.read_later(counters.elements_.data(), counters_.size_bytes());
}

PendingRead NodePool::read_late_inserts(std::array<cl_uint, 2>& words) const {
    static_assert(offsetof(cellist_shard, late_high) ==
                  offsetof(cellist_shard, late_low) + sizeof(cl_uint));
    // After the last shard, see cellist_count_unstored.
    const std::uint64_t from = (shard_elements() - 1) * sizeof(cellist_shard);
    return counters_.read_later(words.data(), sizeof words,
                                from + offsetof(cellist_shard, late_low));
}

}  // namespace cellist::detail
