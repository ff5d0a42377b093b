// SPDX-License-Identifier: MIT
#include "tune/automatic.hpp"

#include <exception>

#include "device/device_state.hpp"
#include "device/preparation.hpp"
#include "tune/measure.hpp"

namespace cellist::detail {

AutomaticStorage::AutomaticStorage(RecordKernels& kernels, const Shape& shape,
                                   const ListsOptions& options)
    : ContainerStorage(kernels, nullptr),
      shape_(shape),
      options_(options),
      tuner_({shape.cells(), kernels.record().size, options}, kernels.owner()->profile()) {
    use(tuner_.storage());
}

/// Makes a storage, or another where this one cannot be made, in the place of the one in use. The
/// old pool goes first, so that the device never holds both.
void AutomaticStorage::use(Storage storage) {
    if (in_place_ == storage) return;
    in_place_.reset();
    if (storage_) storage_->release_pool();
    std::exception_ptr error;
    for (std::optional<Storage> next = storage; next;) {
        try {
            storage_ = make_storage(kernels_, shape_, tuner_.options(*next));
            in_place_ = next;
            return;
        } catch (const Error& reason) {
            const auto* failure = dynamic_cast<const OpenClError*>(&reason);
            const bool in_all = failure != nullptr && !out_of_memory(*failure);
            // Linked lists have the widest limits: what stops them is what counts.
            if (!error || in_all || *next == Storage::linked) error = std::current_exception();
            if (in_all) break;
            next = tuner_.exclude(*next, std::string("not possible: ") + reason.what());
        }
    }
    std::rethrow_exception(error);
}

void AutomaticStorage::start() {
    if (!in_slices_) use(tuner_.storage());
    storage_->start({});
}

void AutomaticStorage::adopt_choice(const ContainerStorage& other) {
    tuner_ = dynamic_cast<const AutomaticStorage&>(other).tuner_;
    use(other.in_use().kind());
}

/// Excludes the storage in use from the choice, and starts the build anew in another. False if
/// there is none.
bool AutomaticStorage::replace(const BuildReport& report, const char* why,
                               StorageTuner::Exclusion exclusion) {
    const std::optional<Storage> other = tuner_.exclude(storage_->kind(), why, exclusion);
    if (!other) return false;
    tuner_.expect(report.stored + report.dropped);
    const Kept kept = storage_->kept();
    use(*other);
    storage_->start(kept);
    return true;
}

bool AutomaticStorage::review(BuildReport& report) {
    using Exclusion = StorageTuner::Exclusion;
    if (in_slices_) return storage_->review(report);
    const bool fixed = storage_->kind() == Storage::fixed;
    try {
        const bool complete = storage_->review(report);
        if (!complete || !fixed || report.dropped == 0) return complete;
        // The others drop less, or nothing.
        return !replace(report, "left: a list was longer than slots", Exclusion::this_trial);
    } catch (const UnrepeatableError&) {
        if (!replace(report, "left: the kernel does not repeat itself", Exclusion::permanent))
            throw;
    } catch (const OverflowError&) {
        if (!fixed && options_.overflow == Overflow::stop) throw;
        const std::exception_ptr error = std::current_exception();
        bool replaced = false;
        try {
            replaced =
                replace(report, "left: the lists did not fit any more", Exclusion::this_trial);
        } catch (const OpenClError&) {
            throw;
        } catch (const Error&) {
            // The others have no room either.
        }
        if (!replaced) std::rethrow_exception(error);
    }
    return false;
}

BuildReport AutomaticStorage::build_once(const std::function<BuildReport()>& run) {
    if (!tuner_.on_trial()) {
        const BuildReport report = run();
        tuner_.built(report.stored);
        return report;
    }
    if (Preparation* preparation = Preparation::current()) preparation->repeat();
    const Storage tried = tuner_.storage();
    Measurement measurement;
    const BuildReport report = measure(*this, run, measurement);
    if (storage_->kind() == tried)
        tuner_.measured(measurement);
    else
        tuner_.built(report.stored);
    return report;
}

BuildReport AutomaticStorage::build(const std::function<BuildReport()>& run) {
    std::exception_ptr first;
    for (std::size_t tried = 1;; ++tried) {
        try {
            return build_once(run);
        } catch (const OpenClError& error) {
            if (!first) first = std::current_exception();
            // Drivers may find out in the middle of a build that they have no memory for it. Where
            // all storages fail, the device is lost.
            if (!out_of_memory(error) || tried == choices.size() ||
                !tuner_.exclude(storage_->kind(),
                                std::string("left: ") + error.call() + " found no memory"))
                std::rethrow_exception(first);
        }
    }
}

/// Slots are for the records of all cells, not for the budget.
void AutomaticStorage::begin_slices() {
    use(tuner_.storage() == Storage::fixed ? Storage::linked : tuner_.storage());
    in_slices_ = true;
}

void AutomaticStorage::end_slices() {
    in_slices_ = false;
    ContainerStorage::end_slices();
}

std::unique_ptr<ContainerStorage> make_container_storage(RecordKernels& kernels, const Shape& shape,
                                                         const ListsOptions& options) {
    if (options.storage == Storage::automatic)
        return std::make_unique<AutomaticStorage>(kernels, shape, options);
    return std::make_unique<ContainerStorage>(kernels, make_storage(kernels, shape, options));
}

}  // namespace cellist::detail
