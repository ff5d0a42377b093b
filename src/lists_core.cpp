#include <algorithm>
#include <limits>
#include <numeric>

#include <cellist/detail/lists_core.hpp>

#include "cellist_kernels.hpp"
#include "device_state.hpp"
#include "view.hpp"

namespace cellist::detail {

static_assert(Shape::extent_max == CELLIST_EXTENT_MAX);
static_assert(Shape::cells_max < CELLIST_NONE);

namespace {

/// Builds in which the demand grows with every pass end here: the kernel does not repeat itself.
constexpr std::uint32_t passes_max = 8;

constexpr std::uint64_t default_capacity_nodes = 65536;

/// As cellist_findings in validate.cl.
struct Findings {
    cl_uint broken_links;
    cl_uint repeated_nodes;
    cl_uint reached_nodes;
    cl_uint first_bad_cell;
};

std::uint64_t wide(cl_uint low, cl_uint high) { return (std::uint64_t{high} << 32) | low; }

/// Four blocks a shard at least: more shards in a small pool only make the search for the last free
/// nodes longer.
std::uint32_t shard_bits_for(std::uint64_t capacity_nodes, Allocation allocation) {
    if (allocation == Allocation::global) return 0;
    std::uint32_t bits = 0;
    while (bits < CELLIST_SHARD_BITS_MAX &&
           (std::uint64_t{4} * CELLIST_BLOCK_NODES << (bits + 1)) <= capacity_nodes)
        ++bits;
    return bits;
}

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes (" + std::to_string(bytes >> 20) + " MiB)";
}

}  // namespace

ListsCore::ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                     const Shape& shape, const ListsOptions& options)
    : device_(std::move(device)),
      definitions_(std::move(definitions)),
      shape_(shape),
      options_(options),
      node_(node_layout(definitions_.records.back())) {
    if (!options_.capacity_nodes && options_.overflow != Overflow::grow)
        throw Error("Overflow::stop and Overflow::drop need capacity_nodes");
    std::uint64_t capacity =
        options_.capacity_nodes.value_or(std::max(shape_.cells(), default_capacity_nodes));
    if (!options_.capacity_nodes && refusal(capacity)) capacity = 0;
    if (const auto reason = refusal(capacity)) throw Error(*reason);
    heads_ = Memory(device_, shape_.cells(), sizeof(cl_uint), "head buffer");
    allocate_pool(capacity);
    clear();
}

std::uint64_t ListsCore::bytes_with(std::uint64_t capacity_nodes) const {
    const std::uint64_t shards =
        (std::uint64_t{1} << shard_bits_for(capacity_nodes, options_.allocation)) + 1;
    return shape_.cells() * sizeof(cl_uint) + capacity_nodes * node_.size +
           shards * sizeof(cellist_shard);
}

std::uint64_t ListsCore::pool_bytes() const { return bytes_with(capacity_nodes_); }

/// Why the pool cannot have this capacity, if it cannot.
std::optional<std::string> ListsCore::refusal(std::uint64_t capacity_nodes) const {
    const std::uint64_t allocation = device_->info.max_allocation_bytes;
    const std::uint64_t limit =
        std::min<std::uint64_t>(allocation / node_.size, CELLIST_CAPACITY_NODES_MAX);
    if (capacity_nodes > limit)
        return "capacity of " + std::to_string(capacity_nodes) + " nodes of " +
               std::to_string(node_.size) + " bytes exceeds this device's limit of " +
               std::to_string(limit) + " nodes (" + mebibytes(allocation) +
               " per allocation): lower capacity_nodes or build in slices";
    if (shape_.cells() > allocation / sizeof(cl_uint))
        return "a shape of " + shape_.to_string() + " cells exceeds this device's limit of " +
               std::to_string(allocation / sizeof(cl_uint)) + " cells (" + mebibytes(allocation) +
               " per allocation)";
    if (bytes_with(capacity_nodes) > options_.budget_bytes)
        return "a pool of " + std::to_string(capacity_nodes) + " nodes and " +
               std::to_string(shape_.cells()) + " cells takes " +
               mebibytes(bytes_with(capacity_nodes)) + ", over the budget of " +
               mebibytes(options_.budget_bytes) + ": raise budget_bytes or build in slices";
    return {};
}

void ListsCore::allocate_pool(std::uint64_t capacity_nodes) {
    // The old nodes go first, so that the device never holds both pools.
    capacity_nodes_ = 0;
    shard_bits_ = 0;
    nodes_ = Memory();
    const std::uint32_t bits = shard_bits_for(capacity_nodes, options_.allocation);
    shards_ = Memory(device_, (std::uint64_t{1} << bits) + 1, sizeof(cellist_shard), "counters");
    shard_bits_ = bits;
    nodes_ = Memory(device_, capacity_nodes, node_.size, "pool");
    capacity_nodes_ = capacity_nodes;
}

void ListsCore::clear() {
    constexpr cl_uint none = CELLIST_NONE;
    constexpr cl_uint zero = 0;
    heads_.fill(&none, sizeof none, heads_.size_bytes());
    shards_.fill(&zero, sizeof zero, shards_.size_bytes());
}

/// Leaves the lists empty, whatever failed before. A pool that could not be allocated becomes one of
/// capacity 0, which grows in the next build.
void ListsCore::empty_after_failure() noexcept {
    try {
        if (nodes_.cl()() == nullptr) allocate_pool(0);
        clear();
    } catch (const Error&) {
        // The device is lost; the error that is under way says why.
    }
}

BuildReport ListsCore::build(const std::function<void()>& insert) {
    BuildReport report;
    try {
        for (;;) {
            clear();
            insert();
            const Counters counters = read_counters();
            report.stored = counters.stored;
            report.dropped = counters.dropped;
            report.rejected = counters.rejected;
            report.attempted = counters.stored + counters.dropped + counters.rejected;
            report.capacity_nodes = capacity_nodes_;
            ++report.passes;
            if (counters.dropped == 0 || options_.overflow == Overflow::drop) return report;

            const std::uint64_t demand = counters.stored + counters.dropped;
            if (options_.overflow == Overflow::stop)
                throw OverflowError("the pool of " + std::to_string(capacity_nodes_) +
                                        " nodes is too small for " + std::to_string(demand) +
                                        " records: raise capacity_nodes or use Overflow::grow",
                                    report);
            if (const auto reason = refusal(demand)) throw OverflowError(*reason, report);
            if (report.passes == passes_max)
                throw OverflowError("the kernel inserted more records in each of " +
                                        std::to_string(passes_max) +
                                        " passes: it must insert the same records every time",
                                    report);
            allocate_pool(demand);
        }
    } catch (...) {
        empty_after_failure();
        throw;
    }
}

ListsCore::Counters ListsCore::read_counters() const {
    std::vector<cellist_shard> shards((std::size_t{1} << shard_bits_) + 1);
    shards_.read(shards.data(), shards.size() * sizeof(cellist_shard));
    Counters sum;
    for (const cellist_shard& shard : shards) {
        sum.stored += shard.allocated;
        sum.dropped += wide(shard.dropped_low, shard.dropped_high);
        sum.rejected += wide(shard.rejected_low, shard.rejected_high);
    }
    return sum;
}

/// A kernel of the library for this record. `key` is the sort key that it is compiled for.
Kernel& ListsCore::kernel(const std::string& name, std::string_view source,
                          const std::string& key) const {
    const std::string id = name + "\n" + key;
    if (const auto known = kernels_.find(id); known != kernels_.end()) return known->second;
    const std::string record = definitions_.records.back().name;
    std::string text = "#define CELLIST_RECORD " + record + "\n";
    if (!key.empty())
        text +=
            "static inline ulong cellist_sort_key(CELLIST_RECORD record)\n{\n    return "
            "cellist_order(\n#line 1 \"sort expression\"\n" +
            key + "\n);\n}\n";
    text += "#line 1 \"" + name + ".cl\"\n" + std::string(source);
    return kernels_
        .emplace(id, Kernel(device_, Source{.text = std::move(text)}, name, definitions_))
        .first->second;
}

Range ListsCore::cell_range() const { return Range::padded(shape_.cells()); }

void ListsCore::add_to(Arguments& arguments) const {
    const cellist_view view{
        {static_cast<cl_uint>(shape_.extent(0)), static_cast<cl_uint>(shape_.extent(1)),
         static_cast<cl_uint>(shape_.extent(2)), static_cast<cl_uint>(shape_.extent(3))},
        static_cast<cl_uint>(shape_.cells()),
        static_cast<cl_uint>(capacity_nodes_),
        shard_bits_};
    arguments.add(nodes_.cl());
    arguments.add(heads_.cl());
    arguments.add(shards_.cl());
    arguments.append(Arguments::Kind::value, &view, sizeof view);
}

void Arguments::add_lists(const ListsCore& lists) { lists.add_to(*this); }

cl::Event ListsCore::sort(const std::string& key) {
    Arguments arguments;
    add_to(arguments);
    return kernel("cellist_sort", kernels::sort_cl, key).enqueue(cell_range(), arguments);
}

std::vector<cl_uint> ListsCore::cell_lengths() const {
    Memory lengths(device_, shape_.cells(), sizeof(cl_uint), "length buffer");
    Arguments arguments;
    add_to(arguments);
    arguments.add(lengths.cl());
    kernel("cellist_lengths", kernels::lengths_cl).enqueue(cell_range(), arguments);
    std::vector<cl_uint> values(shape_.cells());
    lengths.read(values.data(), values.size() * sizeof(cl_uint));
    return values;
}

Lengths ListsCore::lengths() const {
    Lengths result;
    result.histogram.resize(1);
    for (const cl_uint length : cell_lengths()) {
        if (length >= result.histogram.size()) result.histogram.resize(std::size_t{length} + 1);
        ++result.histogram[length];
        result.total += length;
        result.nonempty_cells += length > 0 ? 1 : 0;
        result.longest = std::max<std::uint64_t>(result.longest, length);
    }
    return result;
}

std::vector<std::uint64_t> ListsCore::download(
    const std::function<void*(std::uint64_t)>& allocate) const {
    const std::vector<cl_uint> lengths = cell_lengths();
    std::vector<std::uint64_t> offsets(lengths.size() + 1, 0);
    std::inclusive_scan(lengths.begin(), lengths.end(), offsets.begin() + 1, std::plus<>(),
                        std::uint64_t{0});

    const std::size_t record_bytes = definitions_.records.back().size;
    auto* target = static_cast<std::byte*>(allocate(offsets.back()));
    Memory device_offsets(device_, offsets.size(), sizeof(cl_ulong), "offset buffer");
    device_offsets.write(offsets.data(), offsets.size() * sizeof(cl_ulong));

    // Up to 256 MiB of lists at a time, at least one list, so that the copy fits beside the pool.
    const std::uint64_t most = (std::uint64_t{256} << 20) / record_bytes;
    Kernel& gather = kernel("cellist_gather", kernels::gather_cl);
    for (std::size_t begin = 0; begin < lengths.size();) {
        std::size_t end = begin + 1;
        while (end < lengths.size() && offsets[end + 1] - offsets[begin] <= most) ++end;
        const std::uint64_t count = offsets[end] - offsets[begin];
        if (count > 0) {
            Memory records(device_, count, record_bytes, "download buffer");
            Arguments arguments;
            add_to(arguments);
            arguments.add(static_cast<cl_uint>(begin));
            arguments.add(static_cast<cl_uint>(end));
            arguments.add(device_offsets.cl());
            arguments.add(records.cl());
            gather.enqueue(Range::padded(end - begin), arguments);
            records.read(target + offsets[begin] * record_bytes, count * record_bytes);
        }
        begin = end;
    }
    return offsets;
}

Validation ListsCore::validate() const {
    constexpr cl_uint zero = 0;
    Memory reached(device_, (capacity_nodes_ + 31) / 32, sizeof(cl_uint), "validation buffer");
    reached.fill(&zero, sizeof zero, reached.size_bytes());
    Findings findings{0, 0, 0, CELLIST_NONE};
    Memory device_findings(device_, 1, sizeof findings, "findings");
    device_findings.write(&findings, sizeof findings);

    Arguments arguments;
    add_to(arguments);
    arguments.add(reached.cl());
    arguments.add(device_findings.cl());
    kernel("cellist_validate", kernels::validate_cl).enqueue(cell_range(), arguments);
    device_findings.read(&findings, sizeof findings);

    return {findings.broken_links, findings.repeated_nodes,
            read_counters().stored - findings.reached_nodes, findings.first_bad_cell};
}

}  // namespace cellist::detail
