#include "storage.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

static_assert(Shape::extent_max == CELLIST_EXTENT_MAX);
static_assert(Shape::cells_max < CELLIST_NONE);
static_assert(sizeof(cellist_thread_block) == sizeof(cellist_shard));

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

/// Elements of the counters that the owners of thread_slots take.
std::size_t elements_of_threads(cl_uint thread_slots) {
    return thread_slots * sizeof(cl_ulong) / sizeof(cellist_shard);
}

/// Builds that grow as often as this end with an error.
constexpr std::uint32_t growths_max = 8;

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes (" + std::to_string(bytes >> 20) + " MiB)";
}

}  // namespace

ListStorage::ListStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options,
                         cl_uint mode, std::size_t node_bytes, std::uint64_t head_words_a_cell,
                         std::uint64_t more_head_words)
    : device_(kernels.device()),
      kernels_(kernels),
      shape_(shape),
      options_(options),
      mode_(mode),
      node_bytes_(node_bytes),
      slice_{0, shape.cells()} {
    const std::uint64_t allocation = device_->info.max_allocation_bytes;
    const std::uint64_t cell_bytes = head_words_a_cell * sizeof(cl_uint);
    const std::uint64_t more_bytes = more_head_words * sizeof(cl_uint);
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
    const std::uint64_t head_words = head_words_a_cell * shape.cells() + more_head_words;
    const std::uint64_t head_bytes = head_words * sizeof(cl_uint);
    if (head_bytes > options.budget_bytes)
        throw MemoryError("the heads of a shape of " + shape.to_string() + " cells take " +
                          mebibytes(head_bytes) + ", over the budget of " +
                          mebibytes(options.budget_bytes) + ": raise budget_bytes");
    heads_ = Memory(device_, head_words, sizeof(cl_uint), "head buffer");
}

cellist_view ListStorage::view(Inserts inserts) const {
    return {{static_cast<cl_uint>(shape_.extent(0)), static_cast<cl_uint>(shape_.extent(1)),
             static_cast<cl_uint>(shape_.extent(2)), static_cast<cl_uint>(shape_.extent(3))},
            static_cast<cl_uint>(shape_.cells()),
            static_cast<cl_uint>(pool_nodes()),
            shard_bits_,
            mode_,
            slots_,
            static_cast<cl_uint>(slice_.first_cell),
            inserts == Inserts::accepted ? static_cast<cl_uint>(slice_.cells) : 0,
            key_member_,
            threshold_words_,
            thread_slots_with(capacity_nodes_),
            0};
}

void ListStorage::add_to(Arguments& arguments, Inserts inserts) const {
    add_to(arguments, nodes_, heads_, view(inserts));
}

void ListStorage::add_to(Arguments& arguments, const Memory& nodes, const Memory& heads,
                         const cellist_view& view) const {
    arguments.add_nodes(nodes, record().name);
    arguments.add(heads);
    arguments.add(shards_);
    arguments.append(Arguments::Kind::value, &view, sizeof view);
    arguments.add_mode(view.mode);
}

std::uint64_t ListStorage::pool_nodes_with(std::uint64_t capacity_nodes) const {
    return capacity_nodes + std::uint64_t{thread_slots_with(capacity_nodes)} * CELLIST_BLOCK_NODES;
}

std::uint64_t ListStorage::counters_with(std::uint64_t capacity_nodes) const {
    const cl_uint thread_slots = thread_slots_with(capacity_nodes);
    return (std::uint64_t{1} << shard_bits_for(capacity_nodes)) + 1 + thread_slots +
           elements_of_threads(thread_slots);
}

std::uint64_t ListStorage::bytes_with(std::uint64_t capacity_nodes) const {
    return bytes() - replaceable_bytes() + pool_nodes_with(capacity_nodes) * node_bytes_ +
           counters_with(capacity_nodes) * sizeof(cellist_shard);
}

std::uint64_t ListStorage::replaceable_bytes() const {
    return nodes_.size_bytes() + shards_.size_bytes() +
           (back_buffer_ ? back_buffer_->nodes.size_bytes() + back_buffer_->heads.size_bytes() : 0);
}

const ListStorage::BackBuffer* ListStorage::back_buffer() {
    if (back_buffer_) return &*back_buffer_;
    const std::uint64_t heads = mode_ == CELLIST_LINKED ? shape_.cells() : 0;
    if (!has_room_for(bytes() + nodes_.size_bytes() + heads * sizeof(cl_uint))) return nullptr;
    try {
        BackBuffer made{Memory(device_, pool_nodes(), node_bytes_, "second pool"),
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

void ListStorage::swap_back_buffer() noexcept {
    std::swap(nodes_, back_buffer_->nodes);
    std::swap(heads_, back_buffer_->heads);
}

std::optional<std::string> ListStorage::refusal(std::uint64_t capacity_nodes) const {
    const std::uint64_t allocation = device_->info.max_allocation_bytes;
    const std::uint64_t limit =
        std::min<std::uint64_t>(allocation / node_bytes_, CELLIST_CAPACITY_NODES_MAX);
    if (pool_nodes_with(capacity_nodes) > limit)
        return "capacity of " + std::to_string(capacity_nodes) + " nodes of " +
               std::to_string(node_bytes_) + " bytes exceeds this device's limit of " +
               std::to_string(limit) + " nodes (" + mebibytes(allocation) +
               " per allocation): use fewer cells or records, or a smaller record";
    if (bytes_with(capacity_nodes) > options_.budget_bytes)
        return "a pool of " + std::to_string(capacity_nodes) + " nodes and " +
               std::to_string(shape_.cells()) + " cells takes " +
               mebibytes(bytes_with(capacity_nodes)) + ", over the budget of " +
               mebibytes(options_.budget_bytes) + ": raise budget_bytes";
    return {};
}

std::uint64_t ListStorage::most_nodes() const {
    if (options_.overflow != Overflow::grow) return capacity_nodes_;
    std::uint64_t fits = 0;
    std::uint64_t too_many = std::uint64_t{CELLIST_CAPACITY_NODES_MAX} + 1;
    while (too_many - fits > 1) {
        const std::uint64_t middle = fits + (too_many - fits) / 2;
        (refusal(middle) ? too_many : fits) = middle;
    }
    return fits;
}

void ListStorage::require(std::uint64_t demand, const BuildReport& report) const {
    if (options_.overflow == Overflow::stop)
        throw OverflowError("the pool of " + std::to_string(capacity_nodes_) +
                                " nodes is too small for " + std::to_string(demand) +
                                " records: raise capacity_nodes or use Overflow::grow",
                            report);
    if (const auto reason = refusal(demand)) throw OverflowError(*reason, report);
}

void ListStorage::allocate_pool(std::uint64_t capacity_nodes) {
    // The old nodes go first, so that the device never holds both pools.
    capacity_nodes_ = 0;
    nodes_ = Memory();
    back_buffer_.reset();
    const cl_uint bits = shard_bits_for(capacity_nodes);
    shards_ = Memory(device_, counters_with(capacity_nodes), sizeof(cellist_shard), "counters");
    shard_bits_ = bits;
    nodes_ = Memory(device_, pool_nodes_with(capacity_nodes), node_bytes_, "pool");
    capacity_nodes_ = capacity_nodes;
}

PendingRead ListStorage::read_counters(Shards& shards) const {
    shards.resize(shards_.size_bytes() / sizeof(cellist_shard));
    return shards_.read_later(shards.data(), shards.size() * sizeof(cellist_shard));
}

PendingRead ListStorage::read_late(std::array<cl_uint, 2>& words) const {
    static_assert(offsetof(cellist_shard, late_high) ==
                  offsetof(cellist_shard, late_low) + sizeof(cl_uint));
    // Behind the last shard, see cellist_refuse.
    const std::uint64_t from = (std::uint64_t{1} << shard_bits_) * sizeof(cellist_shard);
    return shards_.read_later(words.data(), sizeof words, from + offsetof(cellist_shard, late_low));
}

ListStorage::Counters ListStorage::sum(const Shards& shards, cl_uint thread_slots) {
    Counters sum;
    const std::size_t count = shards.size() - thread_slots - elements_of_threads(thread_slots);
    for (const cellist_shard& shard : std::span(shards).first(count)) {
        sum.allocated += shard.allocated;
        sum.dropped += wide(shard.dropped_low, shard.dropped_high);
        sum.rejected += wide(shard.rejected_low, shard.rejected_high);
        sum.late += wide(shard.late_low, shard.late_high);
    }
    for (const cellist_shard& element : std::span(shards).subspan(count, thread_slots)) {
        const auto hand = std::bit_cast<cellist_thread_block>(element);
        sum.allocated -= (hand.last - hand.node) + (hand.end - hand.next);
    }
    return sum;
}

void ListStorage::clear_heads_and_counters(const Memory& heads, cl_uint head,
                                           std::uint64_t first_word, std::uint64_t words) {
    if (!clear_)
        clear_.emplace(device_,
                       Source{.text = std::string(kernels::clear_cl), .file_name = "clear.cl"},
                       "cellist_clear", Definitions{});
    const std::uint64_t counter_words = shards_.size_bytes() / sizeof(cl_uint);
    Arguments arguments;
    arguments.add(heads.cl());
    arguments.add(cl_ulong{first_word});
    arguments.add(cl_ulong{words});
    arguments.add(head);
    arguments.add(shards_.cl());
    arguments.add(static_cast<cl_uint>(counter_words));
    clear_->enqueue(Range::padded(std::max(words, counter_words)), arguments);
}

void ListStorage::fill_heads(cl_uint value, std::uint64_t first_word, std::uint64_t words) {
    if (words == 0) return;
    check(
        "clEnqueueFillBuffer",
        clEnqueueFillBuffer(device_->ordered_queue()(), heads_.cl()(), &value, sizeof value,
                            first_word * sizeof value, words * sizeof value, 0, nullptr, nullptr));
}

void ListStorage::make_pool(std::uint64_t capacity_nodes) {
    if (const auto reason = refusal(capacity_nodes))
        throw OverflowError("a slice of " + std::to_string(slice_.cells) + " cells: " + *reason,
                            {.attempted = capacity_nodes, .dropped = capacity_nodes});
    allocate_pool(capacity_nodes);
}

void ListStorage::grow_pool(std::uint64_t capacity_nodes, const BuildReport& report) {
    if (++growths_ == growths_max)
        throw OverflowError("the kernel inserted more records in each of " +
                                std::to_string(report.passes) +
                                " passes: it must insert the same records every time",
                            report);
    allocate_pool(capacity_nodes);
}

void ListStorage::update(BuildReport& report, const Counters& counters, std::uint64_t stored) {
    expected_->stored = stored;
    report.stored = stored;
    report.dropped = counters.dropped;
    report.rejected = counters.rejected;
    report.attempted = stored + counters.dropped + counters.rejected;
    report.capacity_nodes = capacity_nodes_;
}

PendingRead ListStorage::find(Findings& findings, Kernel& kernel,
                              const Arguments& arguments) const {
    constexpr cl_uint zero = 0;
    findings.memory.fill(&zero, sizeof zero, sizeof findings.found);
    Arguments all = arguments;
    all.add(findings.memory.cl());
    kernel.enqueue(Range::padded(shape_.cells()), all);
    return findings.memory.read_later(&findings.found, sizeof findings.found);
}

void ListStorage::start() {
    growths_ = 0;
    expect_nothing();
}

void ListStorage::release_pool() noexcept {
    settle();
    if (!released_nodes_) released_nodes_ = capacity_nodes_;
    capacity_nodes_ = 0;
    nodes_ = Memory();
    back_buffer_.reset();
}

void ListStorage::recover(bool without_pool) {
    settle();
    if (released_nodes_ && options_.overflow != Overflow::grow) allocate_pool(*released_nodes_);
    released_nodes_.reset();
    make_whole(without_pool);
    clear();
}

std::unique_ptr<ListStorage> make_storage(RecordKernels& kernels, const Shape& shape,
                                          const ListsOptions& options) {
    if (options.storage.nearest_key())
        return std::make_unique<NearestStorage>(kernels, shape, options);
    const bool fixed = options.storage == Storage::fixed;
    if (options.overflow != Overflow::grow &&
        !(fixed ? options.slots.has_value() : options.capacity_nodes.has_value()))
        throw Error(std::string("an Overflow other than grow needs ") +
                    (fixed ? "slots in Storage::fixed" : "capacity_nodes"));
    switch (options.storage) {
        case Storage::linked:
            return std::make_unique<LinkedStorage>(kernels, shape, options);
        case Storage::counted:
            return std::make_unique<CountedStorage>(kernels, shape, options);
        case Storage::fixed:
            return std::make_unique<FixedStorage>(kernels, shape, options);
        case Storage::automatic:
            break;
    }
    throw Error("unknown storage");
}

}  // namespace cellist::detail
