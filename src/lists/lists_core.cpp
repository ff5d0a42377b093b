#include <algorithm>
#include <utility>

#include <cellist/detail/build.hpp>
#include <cellist/detail/lists_core.hpp>

#include "cellist_kernels.hpp"
#include "device/record_kernels.hpp"
#include "sort/key.hpp"
#include "sort/sort.hpp"
#include "storage/cell_scan.hpp"
#include "storage/container_storage.hpp"
#include "storage/storage_counted.hpp"
#include "tune/automatic.hpp"

namespace cellist::detail {

namespace {

/// Puts another storage in the place of a container's own for as long as it lives.
class ScopedStorage {
public:
    ScopedStorage(ContainerStorage& place, std::unique_ptr<ListStorage> other)
        : place_(place), kept_(place.exchange(std::move(other))) {}
    ~ScopedStorage() {
        place_.in_use().wait_quietly();
        kept_ = place_.exchange(std::move(kept_));
    }
    ScopedStorage(const ScopedStorage&) = delete;
    ScopedStorage& operator=(const ScopedStorage&) = delete;

private:
    ContainerStorage& place_;
    std::unique_ptr<ListStorage> kept_;
};

/// The declaration of a whole record, as gather.cl takes it.
std::string record_declaration(const RecordKernels& kernels) {
    return "struct " + kernels.record().name + " value";
}

/// Work-items that gather values together, on GPUs.
constexpr std::size_t gather_group = 128;

/// Larger records are copied by each work-item alone.
constexpr std::size_t gathered_bytes_most = 256;

bool gathers_together(const RecordKernels& kernels) {
    const DeviceInfo& device = kernels.owner()->info;
    return (device.type & CL_DEVICE_TYPE_GPU) != 0 && device.local_memory_bytes >= 32768 &&
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

}  // namespace

ListsCore::ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                     const Shape& shape, const ListsOptions& options)
    : device_(std::move(device)),
      shape_(shape),
      kernels_(std::make_unique<RecordKernels>(device_, std::move(definitions))),
      storage_(make_container_storage(*kernels_, shape, options)) {}

ListsCore::~ListsCore() {
    if (state_.build) std::shared_ptr(state_.build)->abandon();
    storage_->in_use().wait_quietly();
}

BuildReport ListsCore::build(const std::function<void()>& insert) {
    require_buildable();
    make_ready();
    const auto self = shared_from_this();
    try {
        const BuildReport report = storage_->build(
            [&] { return BuildReport(Build::start({this}, insert)->finish().front()); });
        require_owner(self);
        return report;
    } catch (...) {
        fail(false);
        throw;
    }
}

void ListsCore::fail(bool without_pool) noexcept {
    state_ = {.phase = Phase::failed, .without_pool = without_pool || state_.without_pool};
    try {
        make_ready();
    } catch (...) {
        // The error that is under way says why. What comes next tries again.
    }
}

void ListsCore::make_ready() const {
    if (state_.build) std::shared_ptr(state_.build)->finish();
    if (state_.phase != Phase::failed) return;
    storage_->in_use().recover(state_.without_pool);
    state_ = {};
}

void ListsCore::make_ready_for_commands() const {
    if (!state_.build || state_.build->may_change()) make_ready();
}

void ListsCore::add_to(Arguments& arguments) const {
    make_ready_for_commands();
    storage_->in_use().add_to(arguments, is_building() ? Inserts::accepted : Inserts::refused);
}

void ListsCore::require_owner(const std::shared_ptr<ListsCore>& self) {
    if (self.use_count() == 1)
        throw Error("the lists were destroyed before their build was finished");
}

void ListsCore::require_not_building() const {
    if (state_.phase == Phase::building)
        throw Error("a container is used while it is built: only kernels may, to insert records");
}

void ListsCore::require_buildable() const {
    require_not_building();
    if (state_.phase == Phase::slicing)
        throw Error("a container is built again while a slice of it is read");
}

PendingRead ListsCore::read_late_inserts(std::array<cl_uint, 2>& words) const {
    return storage_->in_use().read_late_inserts(words);
}

std::string ListsCore::description() const {
    return "lists of " + kernels_->record().name + " of shape " + shape_.to_string();
}

void ListsCore::clear() {
    require_not_building();
    Build::count_before_clear(*this);
    make_ready();
    try {
        storage_->in_use().clear();
    } catch (...) {
        fail(false);
        throw;
    }
}

std::function<Validation()> ListsCore::validate() const {
    require_not_building();
    make_ready_for_commands();
    std::function<Validation()> result = storage_->in_use().validate();
    if (!state_.build) return result;
    return [build = state_.build, result = std::move(result)] {
        build->finish();
        return result();
    };
}

std::uint64_t ListsCore::capacity_nodes() const { return storage_->in_use().capacity_nodes(); }
std::uint64_t ListsCore::pool_bytes() const { return storage_->in_use().bytes() + device_.bytes(); }
unsigned ListsCore::mode() const { return storage_->in_use().mode(); }
Storage ListsCore::storage_in_use() const { return storage_->in_use().kind(); }
std::string ListsCore::storage_reason() const { return storage_->reason(); }
cl::Event ListsCore::enqueue_marker() const { return device_->enqueue_marker(); }

void Arguments::add_lists(const ListsCore& lists) {
    if (!lists.is_building()) closed_.push_back({lists.weak_from_this(), arguments_.size()});
    lists.add_to(*this);
}

unsigned read_mode(const ListsCore& lists) { return lists.mode(); }

cl::Event ListsCore::sort(const SortKey& key, std::uint32_t top_k) {
    check_key(key);
    require_not_building();
    make_ready();
    return sorter().sort(storage_->in_use(), key, top_k);
}

cl::Event ListsCore::sort_async(const SortKey& key) {
    check_key(key);
    require_not_building();
    make_ready_for_commands();
    return sorter().sort_in_place(storage_->in_use(), key);
}

ListSorter& ListsCore::sorter() {
    if (!sorter_) sorter_ = std::make_unique<ListSorter>(device_, *kernels_);
    return *sorter_;
}

/// The length of every list, at the start of a device buffer of `words` words.
Memory ListsCore::device_lengths(std::uint64_t words) const {
    require_not_building();
    Memory lengths(device_.state(), words, sizeof(cl_uint), "length buffer");
    Arguments arguments;
    add_to(arguments);
    arguments.add(lengths.cl());
    reading_kernel(*kernels_, "cellist_lengths", mode(), record_declaration(*kernels_), "")
        .enqueue(reading_range(*kernels_, mode(), shape_.cells()), arguments);
    return lengths;
}

PendingRead ListsCore::read_lengths(std::vector<cl_uint>& lengths) const {
    lengths = host_memory<cl_uint>(shape_.cells());
    return device_lengths(shape_.cells())
        .read_later(lengths.data(), lengths.size() * sizeof(cl_uint));
}

/// The number of records in all lists; the greatest possible number while a build that may drop is
/// pending.
std::uint64_t ListsCore::most_records() const {
    return state_.build ? storage_->in_use().capacity_nodes() : storage_->in_use().stored();
}

/// Where each list goes when all lists lie one after the other: cells + 1 offsets.
Memory ListsCore::device_offsets() const {
    Memory words = device_lengths(shape_.cells() + 1);
    // Kept where the budget has room for it.
    const bool fits =
        storage_->in_use().pool().has_room_for(CellScan::bytes_for(device_->info, shape_.cells()));
    std::unique_ptr<CellScan> once;
    if (!scan_)
        (fits ? scan_ : once) = std::make_unique<CellScan>(
            fits ? device_ : MemoryOwner(device_.state()), shape_.cells(), 0);
    CellScan& scan = scan_ ? *scan_ : *once;
    scan.sum(words.cl(), CELLIST_NONE);
    scan.write_offsets(words.cl(), words.cl(), most_records());
    return words;
}

/// Copies a value of each record of the cells begin ... end - 1 to the begin of `values`.
void ListsCore::gather(std::uint64_t begin, std::uint64_t end, const Memory& offsets,
                       const cl::Buffer& values, const std::string& declaration,
                       const std::string& member) const {
    Arguments arguments;
    add_to(arguments);
    arguments.add(static_cast<cl_uint>(begin));
    arguments.add(static_cast<cl_uint>(end));
    arguments.add(offsets.cl());
    arguments.add(values);
    reading_kernel(*kernels_, "cellist_gather", mode(), declaration, member)
        .enqueue(gathers_together(*kernels_) ? Range::padded(end - begin, gather_group)
                                             : reading_range(*kernels_, mode(), end - begin),
                 arguments);
}

void ListsCore::download(ReadbackFence& done, std::vector<cl_uint>& offsets,
                         const std::function<void*(std::uint64_t)>& allocate) const {
    make_ready_for_commands();
    // Up to 256 MiB of lists at a time, at least one list, so that the copy fits beside the pool.
    const std::size_t record_bytes = kernels_->record().size;
    const std::uint64_t most = std::max<std::uint64_t>(
        std::min(std::uint64_t{256} << 20, device_->info.max_allocation_bytes) / record_bytes, 1);
    if (most_records() > most) make_ready();
    const Memory words = device_offsets();
    const std::uint64_t total = most_records();
    auto* target = static_cast<std::byte*>(allocate(total));
    offsets = host_memory<cl_uint>(shape_.cells() + 1);
    done.add(words.read_later(offsets.data(), offsets.size() * sizeof(cl_uint)));

    const auto copy = [&](std::uint64_t begin, std::uint64_t end, std::uint64_t first,
                          std::uint64_t count) {
        if (count == 0) return;
        const Memory records(device_.state(), count, record_bytes, "download buffer");
        gather(begin, end, words, records.cl(), record_declaration(*kernels_), "");
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
    make_ready_for_commands();
    const Memory words = device_offsets();
    opencl([&] {
        device_->ordered_queue().enqueueCopyBuffer(words.cl(), offsets, 0, 0,
                                                   (shape_.cells() + 1) * sizeof(cl_uint));
    });
    gather(0, shape_.cells(), words, allocate(most_records()), declaration, member);
}

void ListsCore::release_kept_buffers() {
    if (!storage_->in_use().pool().has_budget()) return;
    scan_.reset();
    sorter_.reset();
}

/// How many records the kernels insert into each cell. The report says that all of them are
/// dropped.
std::vector<cl_uint> ListsCore::count(const std::function<void()>& insert, BuildReport& report) {
    auto counting = std::make_unique<CountedStorage>(
        *kernels_, shape_,
        ListsOptions{.overflow = Overflow::stop,
                     .capacity_nodes = 0,
                     .periodic = storage_->in_use().options().periodic});
    CountedStorage& counter = *counting;
    const ScopedStorage scoped(*storage_, std::move(counting));
    enter({.phase = Phase::building});
    counter.start();
    counter.begin_pass();
    insert();
    counter.end_pass();
    enter({.phase = Phase::ready});
    return counter.counts(report);
}

/// The cells from `first` on whose lists fit into a pool together, at least one, and their records.
ListsCore::PlannedSlice ListsCore::plan_slice(std::uint64_t first,
                                              const std::vector<cl_uint>& counts) const {
    const ListStorage& storage = storage_->in_use();
    const std::uint64_t most = storage.most_nodes();
    PlannedSlice slice{{first, 1}, counts[first], counts[first]};
    for (std::uint64_t cell = first + 1; cell < shape_.cells(); ++cell) {
        const std::uint64_t total = slice.total + counts[cell];
        const std::uint64_t longest = std::max<std::uint64_t>(slice.longest, counts[cell]);
        if (storage.nodes_for(total, longest, slice.range.cells + 1) > most) break;
        slice = {{first, slice.range.cells + 1}, total, longest};
    }
    return slice;
}

BuildReport ListsCore::build_slices(const std::function<void()>& insert,
                                    const std::function<void(const Slice&)>& read) {
    require_buildable();
    const auto self = shared_from_this();
    Build::count_before_clear(*this);
    make_ready();
    BuildReport all;
    try {
        storage_->begin_slices();
        ListStorage& storage = storage_->in_use();
        const std::vector<cl_uint> counts = count(insert, all);
        const BuildReport counted =
            std::exchange(all, {.attempted = all.attempted, .rejected = all.rejected, .passes = 1});
        for (std::uint64_t first = 0; first < shape_.cells();) {
            release_kept_buffers();
            const PlannedSlice slice = plan_slice(first, counts);
            storage.clear();
            storage.set_slice(slice.range);
            storage.reserve(slice.total, slice.longest);
            const BuildReport report = Build::start({this}, insert)->finish().front();
            all.stored += report.stored;
            all.dropped += report.dropped;
            all.passes += report.passes;
            all.capacity_nodes = std::max(all.capacity_nodes, report.capacity_nodes);
            if (report.stored + report.dropped != slice.total ||
                report.rejected != counted.rejected)
                throw Error("the kernel inserted " +
                            std::to_string(report.stored + report.dropped) +
                            " records into a slice of " + std::to_string(slice.range.cells) +
                            " cells, and " + std::to_string(slice.total) +
                            " when it counted them: it must insert the same records every time");
            enter({.phase = Phase::slicing});
            read(slice.range);
            if (state_.phase == Phase::slicing) enter({.phase = Phase::ready});
            first += slice.range.cells;
        }
        storage_->end_slices();
        storage.recover(false);
    } catch (...) {
        storage_->end_slices();
        fail(false);
        throw;
    }
    require_owner(self);
    return all;
}

}  // namespace cellist::detail
