#include <algorithm>
#include <numeric>

#include <cellist/detail/lists_core.hpp>

#include "cellist_kernels.hpp"
#include "storage.hpp"

namespace cellist::detail {

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

BuildReport ListsCore::build(const std::function<void()>& insert) {
    try {
        return storage_->build(insert);
    } catch (...) {
        try {
            storage_->recover();
            storage_->clear();
        } catch (const Error&) {
            // The device is lost; the error that is under way says why.
        }
        throw;
    }
}

void ListsCore::clear() { storage_->clear(); }
Validation ListsCore::validate() const { return storage_->validate(); }
std::uint64_t ListsCore::capacity_nodes() const { return storage_->capacity_nodes(); }
std::uint64_t ListsCore::pool_bytes() const { return storage_->bytes(); }
unsigned ListsCore::mode() const { return storage_->mode(); }
void ListsCore::add_to(Arguments& arguments) const { storage_->add_to(arguments); }

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

void Arguments::add_lists(const ListsCore& lists) { lists.add_to(*this); }

unsigned read_mode(const ListsCore& lists) { return lists.mode(); }

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

}  // namespace cellist::detail
