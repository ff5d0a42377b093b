// SPDX-License-Identifier: MIT
// What adds records to lists, and removes some.
#include "lists/append.hpp"

#include <utility>

#include <cellist/detail/build.hpp>

#include "cellist_kernels.hpp"
#include "device/record_kernels.hpp"
#include "sort/key.hpp"
#include "sort/sort.hpp"
#include "storage/cell_scan.hpp"
#include "storage/container_storage.hpp"

namespace cellist::detail {

BuildReport ListsCore::append(const std::function<void()>& insert) {
    const auto self = shared_from_this();
    const BuildReport report = Build::start({this}, insert, Existing::kept)->finish().front();
    require_owner(self);
    return report;
}

/// An append to empty lists is a build.
void ListsCore::keep_records() {
    if (storage_->in_use().stored() > 0) append_ = std::make_unique<Append>();
}

void ListsCore::start_build() {
    if (!append_) return storage_->start();
    ListStorage& storage = storage_->in_use();
    Kept kept{.records = storage.stored()};
    if (storage.can_mark()) {
        storage.start(kept);
        storage.mark();
        append_->is_marked = true;
    } else {
        append_->copy = packed();
        kept.offsets = append_->copy->offsets.get();
        release_kept_buffers();
        storage.start(kept);
    }
}

void ListsCore::begin_pass() {
    storage_->in_use().begin_pass();
    if (append_ && append_->copy) storage_->in_use().insert(*append_->copy);
}

bool ListsCore::review(BuildReport& report) {
    if (append_ && append_->copy) append_->copy->reading.wait();
    const bool loses_pool = append_ && append_->is_marked && storage_->review_may_change() &&
                            storage_->in_use().dropped() > 0;
    if (!loses_pool) return storage_->review(report);
    // The review replaces the pool: another pass inserts the existing records from a copy.
    storage_->in_use().return_to_mark();
    append_->is_marked = false;
    append_->copy = packed();
    release_kept_buffers();
    storage_->in_use().set_kept_offsets(*append_->copy->offsets);
    (void)storage_->review(report);
    return false;
}

/// Brings the records of an append back, or empties the lists.
void ListsCore::restore(bool without_pool) const {
    const std::unique_ptr<Append> append = std::exchange(append_, nullptr);
    ListStorage& storage = storage_->in_use();
    if (!append || append->copy) storage.recover(without_pool);
    if (!append) return;
    storage.wait_quietly();
    if (append->is_marked) {
        storage.return_to_mark();
    } else if (append->copy) {
        append->copy->reading.wait();
        // Storage::automatic may have left contiguous lists for slots.
        if (storage.mode() == CELLIST_FIXED && append->copy->totals.longest == 0)
            count_lengths(*append->copy);
        storage.load(*append->copy, *append->copy->offsets, append->copy->totals);
    }
}

BuildReport ListsCore::merge(const ListsCore& other) {
    if (&other == this) throw Error("lists cannot be merged with themselves: merge a copy()");
    if (other.shape() != shape_)
        throw Error("the " + description() + " cannot take the records of the " +
                    other.description() + ": the shapes differ");
    return append([&] {
        Arguments arguments;
        add_to(arguments);
        other.add_to(arguments);
        kernels_
            ->get({{"append.cl", kernels::append_cl}}, "cellist_insert_lists", arguments.modes())
            .enqueue(cell_range(), arguments);
    });
}

std::shared_ptr<ListsCore> ListsCore::copy() const {
    require_buildable();
    make_ready();
    const std::unique_ptr<PackedLists> lists = packed();
    auto made =
        std::make_shared<ListsCore>(device_.state(), kernels_->definitions(), shape_, options_);
    made->storage_->adopt_choice(*storage_);
    lists->reading.wait();
    made->storage_->in_use().load(*lists, *lists->offsets, lists->totals);
    return made;
}

std::uint64_t ListsCore::remove_if(const std::string& expression, const Values& values) {
    SortKey key{expression, 32, Order::ascending, values, "remove_if expression"};
    check_key(key);
    key.expression = "(" + expression + ") != 0";
    const ExpressionProgram program = key_program(key);
    return shorten([&](const PackedLists& copy, const cl::Buffer& lengths) {
        Arguments arguments;
        storage_->in_use().add_contiguous_to(arguments, *copy.records, *copy.offsets);
        arguments.add(lengths);
        arguments.append(program.values);
        kernels_
            ->get({{"remove.cl", kernels::remove_cl}}, "cellist_remove", CELLIST_CONTIGUOUS,
                  program.source, program.types)
            .enqueue(cell_range(), arguments);
    });
}

std::uint64_t ListsCore::shorten(
    const std::function<void(const PackedLists&, const cl::Buffer&)>& write_lengths) {
    require_buildable();
    make_ready();
    std::unique_ptr<PackedLists> lists = packed();
    const Memory offsets(device_.state(), shape_.cells() + 1, sizeof(cl_uint), "new offsets");
    write_lengths(*lists, offsets.cl());
    ListStorage& storage = storage_->in_use();
    std::unique_ptr<CellScan> once;
    CellScan& left = scan(once);
    CellScan::Totals totals;
    left.sum(offsets.cl(), CELLIST_NONE);
    left.write_offsets(offsets.cl(), offsets.cl(), storage.stored());
    lists->reading.add(left.read_later(totals));
    lists->reading.wait();
    const std::uint64_t removed = storage.stored() - totals.sum;
    if (removed == 0) return 0;
    Build::count_before_clear(*this);
    try {
        storage.load(*lists, offsets, totals);
    } catch (...) {
        // The copy still has all records.
        append_ = std::make_unique<Append>(Append{.copy = std::move(lists)});
        fail(false);
        throw;
    }
    return removed;
}

}  // namespace cellist::detail
