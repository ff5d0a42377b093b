// SPDX-License-Identifier: MIT
#include "storage/storage.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "cellist_kernels.hpp"

namespace cellist::detail {

ListStorage::ListStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options,
                         cl_uint mode, const NodePool::Layout& layout)
    : kernels_(kernels),
      shape_(shape),
      options_(options),
      pool_(kernels.owner(), shape, options, layout),
      view_{},
      slice_{0, shape.cells()} {
    for (std::size_t i = 0; i < std::size(view_.extent); ++i)
        view_.extent[i] = static_cast<cl_uint>(shape.extent(i));
    view_.cells = static_cast<cl_uint>(shape.cells());
    view_.mode = mode;
    for (std::size_t i = 0; i < options.periodic.size(); ++i)
        if (options.periodic[i]) view_.periodic_axes |= 1U << i;
}

void ListStorage::require_given(bool given, const char* size) const {
    if (options_.overflow != Overflow::grow && !given)
        throw Error(std::string("an Overflow other than grow needs ") + size);
}

void ListStorage::allocate_first(std::uint64_t capacity_nodes) {
    if (const auto reason = pool_.refusal(capacity_nodes)) throw MemoryError(*reason);
    pool_.allocate(capacity_nodes);
}

cellist_view ListStorage::view(Inserts inserts) const {
    cellist_view view = view_;
    view.first_cell = static_cast<cl_uint>(slice_.first_cell);
    view.open_cells = inserts == Inserts::accepted ? static_cast<cl_uint>(slice_.cells) : 0;
    view.pool_nodes = static_cast<cl_uint>(pool_.nodes_count());
    view.shard_bits = pool_.shard_bits();
    view.thread_slots = pool_.thread_slots();
    return view;
}

void ListStorage::add_to(Arguments& arguments, Inserts inserts) const {
    add_to(arguments, pool_.nodes(), pool_.heads(), view(inserts));
}

void ListStorage::add_contiguous_to(Arguments& arguments, const Memory& records,
                                    const Memory& offsets) const {
    cellist_view contiguous = view(Inserts::refused);
    contiguous.mode = CELLIST_CONTIGUOUS;
    add_to(arguments, records, offsets, contiguous);
}

void ListStorage::add_to(Arguments& arguments, const Memory& nodes, const Memory& heads,
                         const cellist_view& view) const {
    arguments.add_nodes(nodes, record().name);
    arguments.add(heads);
    arguments.add(pool_.counters());
    arguments.append(Arguments::Kind::value, &view, sizeof view);
    arguments.add_mode(view.mode);
}

void ListStorage::start(const Kept& kept) {
    pool_.start_build();
    kept_ = kept;
    mark_.reset();
    if (kept.records == 0)
        expect_nothing();
    else
        expected_ = std::make_shared<Expected>(*expected_);
}

bool ListStorage::can_save(const Memory& memory) const {
    return saved_.size_bytes() == memory.size_bytes() || pool_.has_room_for(memory.size_bytes());
}

void ListStorage::allocate_saved(const Memory& memory) {
    if (saved_.size_bytes() != memory.size_bytes())
        saved_ = Memory(pool_.owner(), memory.size_bytes(), 1, "second copy of the heads");
}

void ListStorage::copy(const Memory& from, const Memory& to, std::uint64_t bytes) const {
    if (bytes == 0) return;
    opencl(
        [&] { pool_.owner()->ordered_queue().enqueueCopyBuffer(from.cl(), to.cl(), 0, 0, bytes); });
}

Counters::Sum ListStorage::wait_for_counters() {
    reading_.wait();
    return counters_.sum();
}

void ListStorage::release_pool() noexcept {
    wait_quietly();
    pool_.release();
}

void ListStorage::recover(bool without_pool) {
    wait_quietly();
    pool_.recover(without_pool);
    reset_passes();
    clear();
}

void ListStorage::reserve(std::uint64_t total, std::uint64_t) {
    if (options_.overflow == Overflow::grow && capacity_nodes() < total)
        pool_.allocate_for_slice(total, slice_.cells);
}

void ListStorage::update(BuildReport& report, std::uint64_t demand, std::uint64_t stored,
                         std::uint64_t rejected) {
    expected_->stored = stored;
    report.stored = stored;
    report.dropped = demand - stored;
    report.rejected = rejected;
    report.existing = kept_.records;
    report.attempted = demand + rejected - kept_.records;
    report.capacity_nodes = pool_.capacity_nodes();
}

void ListStorage::insert(const PackedLists& copy) {
    Arguments arguments;
    add_to(arguments, Inserts::accepted);
    add_contiguous_to(arguments, *copy.records, *copy.offsets);
    kernels_
        .get({{"append.cl", kernels::append_cl}}, "cellist_insert_lists",
             mode() | CELLIST_CONTIGUOUS)
        .enqueue(Range::padded(shape_.cells()), arguments);
}

void ListStorage::load(const PackedLists& packed, const Memory& offsets,
                       const CellScan::Totals& totals) {
    reserve(totals.sum, totals.longest);
    clear();
    Arguments arguments;
    add_to(arguments);
    add_contiguous_to(arguments, *packed.records, *packed.offsets);
    arguments.add(offsets.cl());
    kernels_.get({{"load.cl", kernels::load_cl}}, "cellist_load", mode() | CELLIST_CONTIGUOUS)
        .enqueue(Range::padded(std::max(shape_.cells(), pool_.counter_elements())), arguments);
    expected_ = std::make_shared<Expected>(Expected{totals.sum, totals.hash});
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

std::unique_ptr<ListStorage> make_storage(RecordKernels& kernels, const Shape& shape,
                                          const ListsOptions& options) {
    const std::string_view storage =
        options.storage.nearest_key() ? "nearest" : name_of(options.storage);
#define CELLIST_MAKE_STORAGE(name, modes, unused, unused_too)                                      \
    if (storage == #name) return make_##name(kernels, shape, options);
    CELLIST_STORAGES(CELLIST_MAKE_STORAGE, , )
#undef CELLIST_MAKE_STORAGE
    throw Error("unknown storage");
}

}  // namespace cellist::detail
