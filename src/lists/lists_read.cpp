// SPDX-License-Identifier: MIT
// Lengths and copies of the lists.
#include <algorithm>
#include <utility>

#include <cellist/detail/lists_core.hpp>

#include "cellist_kernels.hpp"
#include "device/record_kernels.hpp"
#include "lists/append.hpp"
#include "sort/sort.hpp"
#include "storage/cell_scan.hpp"
#include "storage/container_storage.hpp"

namespace cellist::detail {

namespace {

/// The declaration of a whole record, as gather.cl takes it.
std::string record_declaration(const RecordKernels& kernels) {
    return kernels.record().type() + " value";
}

/// Work-items that gather values together, on GPUs.
constexpr std::size_t gather_group = 128;

/// Larger records are copied by each work-item alone.
constexpr std::size_t gathered_bytes_most = 256;

bool gathers_together(const RecordKernels& kernels) {
    const DeviceInfo& device = kernels.owner()->info;
    return device.is_gpu() && device.local_memory_bytes >= 32768 &&
           device.max_work_group_size >= gather_group &&
           kernels.record().size <= gathered_bytes_most;
}

/// Cells of a work-item that follows the links of several lists together, on processors.
constexpr std::size_t reader_cells = 128;

bool reads_several_lists(const RecordKernels& kernels, unsigned mode) {
    return (kernels.owner()->info.type & CL_DEVICE_TYPE_CPU) != 0 && mode == CELLIST_LINKED;
}

/// Of a kernel that reads the lists of so many cells.
Range reading_range(const RecordKernels& kernels, unsigned mode, std::uint64_t cells) {
    return reads_several_lists(kernels, mode) ? Range::padded(cells / reader_cells + 1, 1)
                                              : Range::padded(cells);
}

/// A kernel that reads lists. Lengths and copies are one program: who copies lists needs both, and
/// a second program takes longer to compile than a second kernel.
Kernel& reading_kernel(RecordKernels& kernels, const char* name, unsigned mode,
                       const std::string& declaration, const std::string& member) {
    return kernels.get(
        {{"reader.cl", kernels::reader_cl},
         {"lengths.cl", kernels::lengths_cl},
         {"gather.cl", kernels::gather_cl}},
        name, mode,
        "#define CELLIST_VALUE " + declaration + "\n#define CELLIST_MEMBER " + member + "\n" +
            (reads_several_lists(kernels, mode)
                 ? "#define CELLIST_READER_CELLS " + std::to_string(reader_cells) + "u\n"
                 : "") +
            (gathers_together(kernels)
                 ? "#define CELLIST_GATHER_GROUP " + std::to_string(gather_group) + "u\n"
                 : ""));
}

Kernel& lengths_kernel(RecordKernels& kernels, const char* name, unsigned mode) {
    return reading_kernel(kernels, name, mode, record_declaration(kernels), "");
}

}  // namespace

Range ListsCore::cell_range() const { return Range::padded(shape_.cells()); }

void ListsCore::enqueue_lengths(const cl::Buffer& lengths) const {
    Arguments arguments;
    add_to(arguments);
    arguments.add(lengths);
    lengths_kernel(*kernels_, "cellist_lengths", mode())
        .enqueue(reading_range(*kernels_, mode(), shape_.cells()), arguments);
}

void ListsCore::write_lengths(const cl::Buffer& lengths) const {
    require_not_building();
    enqueue_lengths(lengths);
}

void ListsCore::write_histogram(const cl::Buffer& histogram, cl_uint bins) const {
    require_not_building();
    const Memory lengths(device_.state(), shape_.cells(), sizeof(cl_uint), "length buffer");
    enqueue_lengths(lengths.cl());
    lengths_kernel(*kernels_, "cellist_length_histogram", mode())
        .run(cell_range(), lengths.cl(), static_cast<cl_uint>(shape_.cells()), bins, histogram);
}

PendingRead ListsCore::read_lengths(std::vector<cl_uint>& lengths) const {
    const Memory memory(device_.state(), shape_.cells(), sizeof(cl_uint), "length buffer");
    write_lengths(memory.cl());
    lengths = host_memory<cl_uint>(shape_.cells());
    return memory.read_later(lengths.data(), lengths.size() * sizeof(cl_uint));
}

/// The number of records in all lists; the greatest possible number while a build that may drop is
/// pending.
std::uint64_t ListsCore::most_records() const {
    return state_.build ? storage_->in_use().capacity_nodes() : storage_->in_use().stored();
}

/// The scan of lengths. It is kept if the budget has room for it; if not, in `once`.
CellScan& ListsCore::scan(std::unique_ptr<CellScan>& once) const {
    if (scan_) return *scan_;
    const bool fits =
        storage_->in_use().pool().has_room_for(CellScan::bytes_for(device_->info, shape_.cells()));
    std::unique_ptr<CellScan>& place = fits ? scan_ : once;
    place = std::make_unique<CellScan>(fits ? device_ : MemoryOwner(device_.state()),
                                       shape_.cells(), 0);
    return *place;
}

/// Writes the offsets of all lists. The totals of `scan` are those of their lengths then.
void ListsCore::enqueue_offsets(CellScan& scan, const cl::Buffer& offsets) const {
    enqueue_lengths(offsets);
    scan.sum(offsets, CELLIST_NONE);
    scan.write_offsets(offsets, offsets, most_records());
}

void ListsCore::write_offsets(const cl::Buffer& offsets) const {
    require_not_building();
    make_ready_for_commands();
    std::unique_ptr<CellScan> once;
    enqueue_offsets(scan(once), offsets);
}

/// Copies a value of each record of the cells begin ... end - 1 to the begin of `values`.
void ListsCore::gather(std::uint64_t begin, std::uint64_t end, const cl::Buffer& offsets,
                       const cl::Buffer& values, const std::string& declaration,
                       const std::string& member) const {
    Arguments arguments;
    add_to(arguments);
    arguments.add(static_cast<cl_uint>(begin));
    arguments.add(static_cast<cl_uint>(end));
    arguments.add(offsets);
    arguments.add(values);
    reading_kernel(*kernels_, "cellist_gather", mode(), declaration, member)
        .enqueue(gathers_together(*kernels_) ? Range::padded(end - begin, gather_group)
                                             : reading_range(*kernels_, mode(), end - begin),
                 arguments);
}

/// Enqueues a copy of all lists. A build that may still drop records is not pending.
std::unique_ptr<PackedLists> ListsCore::packed() const {
    auto lists = std::make_unique<PackedLists>();
    // Some drivers take longer to make and release memory than to write it.
    const bool keeps = !storage_->in_use().pool().has_budget();
    lists->offsets = copied_offsets_;
    if (!lists->offsets)
        lists->offsets =
            std::make_shared<Memory>(keeps ? device_ : MemoryOwner(device_.state()),
                                     shape_.cells() + 1, sizeof(cl_uint), "offsets of a copy");
    if (keeps) copied_offsets_ = lists->offsets;
    const std::uint64_t records = most_records();
    const std::size_t record_bytes = kernels_->record().size;
    lists->records = storage_->in_use().spare_memory(records * record_bytes);
    if (!lists->records)
        lists->records =
            std::make_shared<Memory>(device_.state(), records, record_bytes, "copy of all records");
    if (mode() == CELLIST_CONTIGUOUS) {
        storage_->in_use().copy_contiguous(*lists);
        lists->totals.sum = records;
        return lists;
    }
    std::unique_ptr<CellScan> once;
    CellScan& lengths = scan(once);
    enqueue_offsets(lengths, lists->offsets->cl());
    lists->reading.add(lengths.read_later(lists->totals));
    gather(0, shape_.cells(), lists->offsets->cl(), lists->records->cl(),
           record_declaration(*kernels_), "");
    return lists;
}

/// Makes the totals of a copy complete.
void ListsCore::count_lengths(PackedLists& copy) const {
    const Memory words(device_.state(), shape_.cells(), sizeof(cl_uint), "length buffer");
    Arguments arguments;
    storage_->in_use().add_contiguous_to(arguments, *copy.records, *copy.offsets);
    arguments.add(words.cl());
    lengths_kernel(*kernels_, "cellist_lengths", CELLIST_CONTIGUOUS)
        .enqueue(cell_range(), arguments);
    std::unique_ptr<CellScan> once;
    CellScan& lengths = scan(once);
    lengths.sum(words.cl(), CELLIST_NONE);
    copy.reading.add(lengths.read_later(copy.totals));
    copy.reading.wait();
}

void ListsCore::download(ReadbackFence& done, std::vector<cl_uint>& offsets,
                         const std::function<void*(std::uint64_t)>& allocate) const {
    make_ready_for_commands();
    // Up to 256 MiB of lists at a time, at least one list, so that the copy fits beside the pool.
    const std::size_t record_bytes = kernels_->record().size;
    const std::uint64_t most = std::max<std::uint64_t>(
        std::min(std::uint64_t{256} << 20, device_->info.max_allocation_bytes) / record_bytes, 1);
    if (most_records() > most) make_ready();
    const Memory words(device_.state(), shape_.cells() + 1, sizeof(cl_uint), "offset buffer");
    write_offsets(words.cl());
    const std::uint64_t total = most_records();
    auto* target = static_cast<std::byte*>(allocate(total));
    offsets = host_memory<cl_uint>(shape_.cells() + 1);
    done.add(words.read_later(offsets.data(), offsets.size() * sizeof(cl_uint)));

    const auto copy = [&](std::uint64_t begin, std::uint64_t end, std::uint64_t first,
                          std::uint64_t count) {
        if (count == 0) return;
        const Memory records(device_.state(), count, record_bytes, "download buffer");
        gather(begin, end, words.cl(), records.cl(), record_declaration(*kernels_), "");
        done.add(records.read_later(target + first * record_bytes, count * record_bytes));
    };
    if (total <= most) return copy(0, shape_.cells(), 0, total);
    for (std::uint64_t begin = 0; begin < shape_.cells();) {
        done.wait();
        std::uint64_t end = begin + 1;
        while (end < shape_.cells() && offsets[end + 1] - offsets[begin] <= most) ++end;
        copy(begin, end, offsets[begin], offsets[end] - offsets[begin]);
        begin = end;
    }
}

void ListsCore::pack(const cl::Buffer& offsets,
                     const std::function<const cl::Buffer&(std::uint64_t)>& allocate,
                     const std::string& declaration, const std::string& member) const {
    write_offsets(offsets);
    // Whole records are copied by the program of downloads.
    gather(0, shape_.cells(), offsets, allocate(most_records()),
           member.empty() ? record_declaration(*kernels_) : declaration, member);
}

}  // namespace cellist::detail
