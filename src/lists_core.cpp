#include <algorithm>
#include <optional>

#include <cellist/detail/lists_core.hpp>

#include "cell_scan.hpp"
#include "cellist_kernels.hpp"
#include "expression.hpp"
#include "storage.hpp"

namespace cellist::detail {

namespace {

/// Builds in which the demand grows with every pass end here: the kernel does not repeat itself.
constexpr std::uint32_t passes_max = 8;

}  // namespace

ListsCore::ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                     const Shape& shape, const ListsOptions& options)
    : device_(std::move(device)),
      definitions_(std::move(definitions)),
      shape_(shape),
      storage_(make_storage(device_, definitions_, shape, options)) {
    definitions_.modes = storage_->mode();
}

ListsCore::ListsCore(ListsCore&&) noexcept = default;
ListsCore& ListsCore::operator=(ListsCore&&) noexcept = default;
ListsCore::~ListsCore() = default;

std::vector<BuildReport> ListsCore::build(std::span<ListsCore* const> containers,
                                          const std::function<void()>& insert) {
    for (std::size_t i = 0; i < containers.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (containers[i] == containers[j])
                throw Error("a build names the same container twice");
    std::vector<BuildReport> reports(containers.size());
    try {
        for (ListsCore* container : containers) container->storage_->start();
        for (std::uint32_t pass = 1;; ++pass) {
            for (ListsCore* container : containers) {
                container->storage_->begin_pass();
                container->storage_->open(true);
            }
            insert();
            for (ListsCore* container : containers) container->storage_->open(false);
            std::optional<std::size_t> incomplete;
            for (std::size_t i = 0; i < containers.size(); ++i)
                if (!containers[i]->storage_->end_pass(reports[i])) incomplete = i;
            if (!incomplete) return reports;
            if (pass == passes_max)
                throw OverflowError("the kernel inserted more records in each of " +
                                        std::to_string(passes_max) +
                                        " passes: it must insert the same records every time",
                                    reports[*incomplete]);
        }
    } catch (const OpenClError& error) {
        // A driver may find out only now that it has no memory for a pool it had granted.
        const bool out_of_memory = error.code() == CL_MEM_OBJECT_ALLOCATION_FAILURE ||
                                   error.code() == CL_OUT_OF_RESOURCES ||
                                   error.code() == CL_OUT_OF_HOST_MEMORY;
        for (ListsCore* container : containers) container->empty_after_failure(out_of_memory);
        throw;
    } catch (...) {
        for (ListsCore* container : containers) container->empty_after_failure(false);
        throw;
    }
}

/// Leaves the lists empty, whatever failed before. `without_pool` gives the nodes' memory back; the
/// next build grows anew.
void ListsCore::empty_after_failure(bool without_pool) noexcept {
    try {
        storage_->open(false);
        storage_->recover(without_pool);
        storage_->clear();
    } catch (...) {
        // The device is lost; the error that is under way says why.
    }
}

void ListsCore::clear() { storage_->clear(); }
Validation ListsCore::validate() const { return storage_->validate(); }
std::uint64_t ListsCore::capacity_nodes() const { return storage_->capacity_nodes(); }
std::uint64_t ListsCore::pool_bytes() const { return storage_->bytes(); }
unsigned ListsCore::mode() const { return storage_->mode(); }
void ListsCore::add_to(Arguments& arguments) const { storage_->add_to(arguments); }

/// A kernel of the library for this record. `key_function` defines cellist_sort_key, for sorting.
Kernel& ListsCore::kernel(const std::string& name, std::string_view source,
                          const std::string& key_function) const {
    const std::string id = name + "\n" + key_function;
    if (const auto known = kernels_.find(id); known != kernels_.end()) return known->second;
    const std::string text = "#define CELLIST_RECORD " + definitions_.records.back().name + "\n" +
                             key_function + "#line 1 \"" + name + ".cl\"\n" + std::string(source);
    return kernels_.emplace(id, Kernel(device_, Source{.text = text}, name, definitions_))
        .first->second;
}

Range ListsCore::cell_range() const { return Range::padded(shape_.cells()); }

void Arguments::add_lists(const ListsCore& lists) { lists.add_to(*this); }

unsigned read_mode(const ListsCore& lists) { return lists.mode(); }

cl::Event ListsCore::sort(const std::string& key, Order order) {
    check_expression(key);
    // Where clang knows that a value is undefined, it is an error: the sort around it would be undefined
    // as well.
    const std::string key_function =
        std::string(
            "#ifdef __clang__\n#pragma clang diagnostic push\n"
            "#pragma clang diagnostic error \"-Wdivision-by-zero\"\n"
            "#pragma clang diagnostic error \"-Warray-bounds\"\n#endif\n"
            "#line 1 \"sort expression\"\n"
            "static inline ulong cellist_sort_key(struct CELLIST_RECORD record) { return ") +
        (order == Order::descending ? "~" : "") + "cellist_order(\n#line 1 \"sort expression\"\n" +
        key + "\n); }\n#ifdef __clang__\n#pragma clang diagnostic pop\n#endif\n";
    Arguments arguments;
    add_to(arguments);
    return kernel("cellist_sort", kernels::sort_cl, key_function).enqueue(cell_range(), arguments);
}

/// The length of every list, in words of a device buffer that start at `at`.
Memory ListsCore::device_lengths(std::uint64_t at) const {
    Memory lengths(device_, at + shape_.cells(), sizeof(cl_uint), "length buffer");
    Arguments arguments;
    add_to(arguments);
    arguments.add(lengths.cl());
    arguments.add(static_cast<cl_uint>(at));
    kernel("cellist_lengths", kernels::lengths_cl).enqueue(cell_range(), arguments);
    return lengths;
}

Lengths ListsCore::lengths() const {
    std::vector<cl_uint> values(shape_.cells());
    device_lengths(0).read(values.data(), values.size() * sizeof(cl_uint));
    Lengths result;
    for (const cl_uint length : values) {
        ++result.histogram[length];
        result.total += length;
        result.nonempty_cells += length > 0 ? 1 : 0;
        result.longest = std::max<std::uint64_t>(result.longest, length);
    }
    return result;
}

/// Where each list goes when all lists lie behind one another: cells + 1 offsets, then scratch.
ListsCore::Offsets ListsCore::device_offsets() const {
    const std::uint64_t counts_at = shape_.cells() + 1;
    Memory words = device_lengths(counts_at);
    CellScan scan(device_, shape_.cells(), static_cast<cl_uint>(counts_at));
    const CellScan::Sums sums = scan.sums(words.cl(), CELLIST_NONE);
    scan.write_offsets(words.cl(), sums, sums.total);
    return {std::move(words), sums.total};
}

/// Copies the lists of the cells begin ... end - 1 to the begin of `records`.
void ListsCore::gather(std::uint64_t begin, std::uint64_t end, const Offsets& offsets,
                       const cl::Buffer& records) const {
    Arguments arguments;
    add_to(arguments);
    arguments.add(static_cast<cl_uint>(begin));
    arguments.add(static_cast<cl_uint>(end));
    arguments.add(offsets.words.cl());
    arguments.add(records);
    kernel("cellist_gather", kernels::gather_cl).enqueue(Range::padded(end - begin), arguments);
}

std::vector<std::uint64_t> ListsCore::download(
    const std::function<void*(std::uint64_t)>& allocate) const {
    const Offsets device = device_offsets();
    std::vector<cl_uint> words(shape_.cells() + 1);
    device.words.read(words.data(), words.size() * sizeof(cl_uint));
    std::vector<std::uint64_t> offsets(words.begin(), words.end());

    // Up to 256 MiB of lists at a time, at least one list, so that the copy fits beside the pool.
    const std::size_t record_bytes = definitions_.records.back().size;
    const std::uint64_t most = (std::uint64_t{256} << 20) / record_bytes;
    auto* target = static_cast<std::byte*>(allocate(device.total));
    for (std::uint64_t begin = 0; begin < shape_.cells();) {
        std::uint64_t end = begin + 1;
        while (end < shape_.cells() && offsets[end + 1] - offsets[begin] <= most) ++end;
        const std::uint64_t count = offsets[end] - offsets[begin];
        if (count > 0) {
            Memory records(device_, count, record_bytes, "download buffer");
            gather(begin, end, device, records.cl());
            records.read(target + offsets[begin] * record_bytes, count * record_bytes);
        }
        begin = end;
    }
    return offsets;
}

void ListsCore::pack(const cl::Buffer& offsets,
                     const std::function<cl::Buffer(std::uint64_t)>& allocate) const {
    const Offsets device = device_offsets();
    opencl([&] {
        device_->queue.enqueueCopyBuffer(device.words.cl(), offsets, 0, 0,
                                         (shape_.cells() + 1) * sizeof(cl_uint));
    });
    gather(0, shape_.cells(), device, allocate(device.total));
}

}  // namespace cellist::detail
