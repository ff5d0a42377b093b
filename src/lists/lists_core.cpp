// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <cellist/detail/build.hpp>
#include <cellist/detail/lists_core.hpp>

#include "device/record_kernels.hpp"
#include "lists/append.hpp"
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

}  // namespace

ListsCore::ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                     const Shape& shape, const ListsOptions& options)
    : device_(std::move(device)),
      shape_(shape),
      options_(options),
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

void ListsCore::enter(BuildState state) {
    if (state.phase == Phase::ready) append_.reset();
    state_ = std::move(state);
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
    restore(state_.without_pool);
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
    counter.start({});
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
