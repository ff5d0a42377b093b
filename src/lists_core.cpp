#include <algorithm>
#include <utility>

#include <cellist/detail/lists_core.hpp>

#include "build.hpp"
#include "cell_scan.hpp"
#include "cellist_kernels.hpp"
#include "expression.hpp"
#include "sort.hpp"
#include "storage_tuner.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

/// Puts another storage in the place of a container's own for as long as it lives.
class ScopedStorage {
public:
    ScopedStorage(std::unique_ptr<ListStorage>& own, std::unique_ptr<ListStorage> other)
        : place_(own), kept_(std::exchange(own, std::move(other))) {}
    ~ScopedStorage() {
        place_->settle();
        std::swap(place_, kept_);
    }
    ScopedStorage(const ScopedStorage&) = delete;
    ScopedStorage& operator=(const ScopedStorage&) = delete;

private:
    std::unique_ptr<ListStorage>& place_;
    std::unique_ptr<ListStorage> kept_;
};

}  // namespace

ListsCore::ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                     const Shape& shape, const ListsOptions& options)
    : device_(std::move(device)),
      definitions_(std::move(definitions)),
      shape_(shape),
      options_(options),
      in_use_(options.storage) {
    if (options.storage == Storage::automatic) {
        tuner_ = std::make_unique<StorageTuner>(
            StorageTuner::Container{shape.cells(), definitions_.records.back().size, options},
            device_->profile());
        use(tuner_->storage());
    } else {
        storage_ = make_storage(device_, definitions_, shape, options);
        definitions_.modes = storage_->mode();
    }
}

ListsCore::~ListsCore() {
    if (pending_) std::exchange(pending_, nullptr)->abandon();
    storage_->settle();
}

std::shared_ptr<Build> ListsCore::start_build(std::vector<ListsCore*> containers,
                                              std::function<void()> insert) {
    for (const ListsCore* container : containers) container->refuse_build();
    auto build = std::make_shared<Build>(std::move(containers), std::move(insert));
    build->enqueue();
    return build;
}

cl::Event ListsCore::marker_of(const std::vector<ListsCore*>& containers) {
    const DeviceState& first = *containers.front()->device_;
    std::vector<cl::Event> all;
    for (const ListsCore* container : containers) {
        const DeviceState& device = *container->device_;
        if (device.queue() == first.queue()) continue;
        all.push_back(device.marker());
        opencl([&] { device.queue.flush(); });
    }
    if (all.empty()) return first.marker();
    all.push_back(first.marker());
    return opencl([&] {
        cl::Event event;
        first.queue.enqueueMarkerWithWaitList(&all, &event);
        return event;
    });
}

cl::Event ListsCore::marker(Build& build) { return build.marker(); }
const std::vector<BuildReport>& ListsCore::finish(Build& build) { return build.finish(); }

/// Leaves the lists empty, whatever failed before. `without_pool` gives the nodes' memory back, where
/// the next build can grow anew.
void ListsCore::empty_after_failure(bool without_pool) noexcept {
    without_pool_ = without_pool || (broken_ && without_pool_);
    broken_ = true;
    try {
        settle();
    } catch (...) {
        // The error that is under way says why. What comes next tries again.
    }
}

void ListsCore::settle() const {
    if (pending_) std::shared_ptr(pending_)->finish();
    if (!broken_) return;
    storage_->recover(without_pool_);
    broken_ = false;
}

void ListsCore::settle_for_commands() const {
    if (!pending_ || pending_->may_change()) settle();
}

void ListsCore::add_to(Arguments& arguments) const {
    settle_for_commands();
    storage_->add_to(arguments);
}

void ListsCore::refuse_orphan(const std::shared_ptr<ListsCore>& self) {
    if (self.use_count() == 1)
        throw Error("the lists were destroyed before their build was finished");
}

void ListsCore::refuse_while_open() const {
    if (storage_->is_open())
        throw Error("a container is used while it is built: only kernels may, to insert records");
}

bool ListsCore::is_open() const { return storage_->is_open(); }

void ListsCore::refuse_build() const {
    refuse_while_open();
    if (reading_slice_) throw Error("a container is built again while a slice of it is read");
}

PendingRead ListsCore::read_late(std::array<cl_uint, 2>& words) const {
    return storage_->read_late(words);
}

std::string ListsCore::description() const {
    return "lists of " + record() + " of shape " + shape_.to_string();
}

void ListsCore::clear() {
    refuse_while_open();
    Build::take_counts(*this);
    settle();
    try {
        storage_->clear();
    } catch (...) {
        empty_after_failure(false);
        throw;
    }
}

std::function<Validation()> ListsCore::validate() const {
    refuse_while_open();
    settle_for_commands();
    std::function<Validation()> result = storage_->validate();
    if (!pending_) return result;
    return [build = pending_, result = std::move(result)] {
        build->finish();
        return result();
    };
}

std::uint64_t ListsCore::capacity_nodes() const { return storage_->capacity_nodes(); }
std::uint64_t ListsCore::pool_bytes() const { return storage_->bytes() + device_.bytes(); }
unsigned ListsCore::mode() const { return storage_->mode(); }
cl::Event ListsCore::marker() const { return device_->marker(); }

/// A kernel of the library for this record, compiled with more definitions in front.
Kernel& ListsCore::kernel(const std::string& name, std::string_view source,
                          const std::string& definitions) const {
    const std::string id = name + "\n" + definitions;
    if (const auto known = kernels_.find(id); known != kernels_.end()) return known->second;
    const std::string text = "#define CELLIST_RECORD " + record() + "\n" + definitions +
                             "#line 1 \"" + name + ".cl\"\n" + std::string(source);
    return kernels_.emplace(id, Kernel(device_, Source{.text = text}, name, definitions_))
        .first->second;
}

Range ListsCore::cell_range() const { return Range::padded(shape_.cells()); }

void Arguments::add_lists(const ListsCore& lists) {
    if (!lists.is_open()) closed_.push_back({lists.weak_from_this(), arguments_.size()});
    lists.add_to(*this);
}

unsigned read_mode(const ListsCore& lists) { return lists.mode(); }

cl::Event ListsCore::sort(const SortKey& key, std::uint32_t front) {
    check_expression(key.expression);
    refuse_while_open();
    settle();
    return sorter().sort(*storage_, key, front);
}

cl::Event ListsCore::sort_async(const SortKey& key) {
    check_expression(key.expression);
    refuse_while_open();
    settle_for_commands();
    return sorter().sort_in_place(*storage_, key);
}

ListSorter& ListsCore::sorter() {
    if (!sorter_) sorter_ = std::make_unique<ListSorter>(device_, definitions_);
    return *sorter_;
}

void ListsCore::sort_as_on(cl_device_type type) { sorter().set_device_type(type); }

/// The length of every list, at the start of a device buffer of `words` words.
Memory ListsCore::device_lengths(std::uint64_t words) const {
    refuse_while_open();
    Memory lengths(device_.state(), words, sizeof(cl_uint), "length buffer");
    Arguments arguments;
    add_to(arguments);
    arguments.add(lengths.cl());
    kernel("cellist_lengths", kernels::lengths_cl).enqueue(cell_range(), arguments);
    return lengths;
}

PendingRead ListsCore::read_lengths(std::vector<cl_uint>& lengths) const {
    lengths.resize(shape_.cells());
    return device_lengths(shape_.cells())
        .read_later(lengths.data(), lengths.size() * sizeof(cl_uint));
}

/// The number of records in all lists; the greatest possible number while a build that may drop is pending.
std::uint64_t ListsCore::most_records() const {
    return pending_ ? storage_->capacity_nodes() : storage_->stored();
}

/// Where each list goes when all lists lie one after the other: cells + 1 offsets.
Memory ListsCore::device_offsets() const {
    Memory words = device_lengths(shape_.cells() + 1);
    if (!scan_) scan_ = std::make_unique<CellScan>(device_, shape_.cells(), 0);
    scan_->sum(words.cl(), CELLIST_NONE);
    scan_->write_offsets(words.cl(), words.cl(), most_records());
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
    kernel("cellist_gather", kernels::gather_cl,
           "#define CELLIST_VALUE " + declaration + "\n#define CELLIST_MEMBER " + member + "\n")
        .enqueue(Range::padded(end - begin), arguments);
}

void ListsCore::download(ReadbackFence& done, std::vector<cl_uint>& offsets,
                         const std::function<void*(std::uint64_t)>& allocate) const {
    settle_for_commands();
    // Up to 256 MiB of lists at a time, at least one list, so that the copy fits beside the pool.
    const std::size_t record_bytes = definitions_.records.back().size;
    const std::uint64_t most = std::max<std::uint64_t>(
        std::min(std::uint64_t{256} << 20, device_->info.max_allocation_bytes) / record_bytes, 1);
    if (most_records() > most) settle();
    const Memory words = device_offsets();
    const std::uint64_t total = most_records();
    auto* target = static_cast<std::byte*>(allocate(total));
    offsets.resize(shape_.cells() + 1);
    done = words.read_later(offsets.data(), offsets.size() * sizeof(cl_uint));

    const auto copy = [&](std::uint64_t begin, std::uint64_t end, std::uint64_t first,
                          std::uint64_t count) {
        if (count == 0) return;
        const Memory records(device_.state(), count, record_bytes, "download buffer");
        gather(begin, end, words, records.cl(), "struct " + record() + " value", "");
        done = records.read_later(target + first * record_bytes, count * record_bytes);
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
    settle_for_commands();
    const Memory words = device_offsets();
    opencl([&] {
        device_->ordered_queue().enqueueCopyBuffer(words.cl(), offsets, 0, 0,
                                                   (shape_.cells() + 1) * sizeof(cl_uint));
    });
    gather(0, shape_.cells(), words, allocate(most_records()), declaration, member);
}

/// How many records the kernels insert into each cell. The report says that all of them are dropped.
std::vector<cl_uint> ListsCore::count(const std::function<void()>& insert, BuildReport& report) {
    auto counting = std::make_unique<CountedStorage>(
        device_, definitions_, shape_,
        ListsOptions{.overflow = Overflow::drop, .capacity_nodes = 0});
    CountedStorage& counter = *counting;
    const ScopedStorage substitute(storage_, std::move(counting));
    counter.start();
    counter.begin_pass();
    insert();
    counter.end_pass();
    return counter.counts(report);
}

/// The cells from `first` on whose lists fit into a pool together, at least one, and their records.
ListsCore::PlannedSlice ListsCore::plan_slice(std::uint64_t first,
                                              const std::vector<cl_uint>& counts) const {
    const std::uint64_t most = storage_->most_nodes();
    PlannedSlice slice{{first, 1}, counts[first], counts[first]};
    for (std::uint64_t cell = first + 1; cell < shape_.cells(); ++cell) {
        const std::uint64_t total = slice.total + counts[cell];
        const std::uint64_t longest = std::max<std::uint64_t>(slice.longest, counts[cell]);
        if (storage_->nodes_for(total, longest, slice.range.cells + 1) > most) break;
        slice = {{first, slice.range.cells + 1}, total, longest};
    }
    return slice;
}

BuildReport ListsCore::build_slices(const std::function<void()>& insert,
                                    const std::function<void(const Slice&)>& read) {
    refuse_build();
    const auto self = shared_from_this();
    Build::take_counts(*this);
    settle();
    BuildReport all;
    const auto take_all_cells = [this] {
        in_slices_ = reading_slice_ = false;
        storage_->set_slice({0, shape_.cells()});
    };
    try {
        // An automatic storage has slots for the records of all cells, not for the budget.
        if (tuner_) use(tuner_->storage() == Storage::fixed ? Storage::linked : tuner_->storage());
        in_slices_ = true;
        const std::vector<cl_uint> counts = count(insert, all);
        const BuildReport counted =
            std::exchange(all, {.attempted = all.attempted, .rejected = all.rejected, .passes = 1});
        for (std::uint64_t first = 0; first < shape_.cells();) {
            const PlannedSlice slice = plan_slice(first, counts);
            storage_->clear();
            storage_->set_slice(slice.range);
            storage_->reserve(slice.total, slice.longest);
            const BuildReport report = finish(*start_build({this}, insert)).front();
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
            reading_slice_ = true;
            read(slice.range);
            reading_slice_ = false;
            first += slice.range.cells;
        }
        take_all_cells();
        storage_->recover(false);
    } catch (...) {
        take_all_cells();
        empty_after_failure(false);
        throw;
    }
    refuse_orphan(self);
    return all;
}

}  // namespace cellist::detail
