// What a container does in Storage::automatic. The choice itself is made in storage_tuner.cpp.

#include <array>
#include <chrono>
#include <exception>
#include <optional>

#include <cellist/detail/lists_core.hpp>

#include "build.hpp"
#include "cellist_kernels.hpp"
#include "storage_tuner.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

/// Seconds until all that `work` enqueues has run on the device.
template <class Work>
double seconds(const DeviceState& device, const Work& work) {
    const auto finish = [&] { opencl([&] { device.queue.finish(); }); };
    finish();
    const auto begin = std::chrono::steady_clock::now();
    work();
    finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

/// Makes an automatic storage, or another where this one cannot be made, in the place of the one in
/// use. The old pool goes first, so that the device never holds both.
void ListsCore::use(Storage storage) {
    if (has_chosen_ && storage == in_use_) return;
    has_chosen_ = false;
    if (storage_) storage_->release_pool();
    std::exception_ptr error;
    for (std::optional<Storage> next = storage; next;) {
        try {
            storage_ = make_storage(device_, definitions_, shape_, tuner_->options(*next));
            in_use_ = *next;
            has_chosen_ = true;
            definitions_.modes = storage_->mode();
            return;
        } catch (const Error& reason) {
            const auto* failure = dynamic_cast<const OpenClError*>(&reason);
            const bool in_all = failure != nullptr && !out_of_memory(*failure);
            // Linked lists have the widest limits: what stops them is what counts.
            if (!error || in_all || *next == Storage::linked) error = std::current_exception();
            if (in_all) break;
            next = tuner_->exclude(*next, std::string("not possible: ") + reason.what());
        }
    }
    if (storage_) empty_after_failure(false);
    std::rethrow_exception(error);
}

void ListsCore::start() {
    if (tuner_ && !in_slices_) use(tuner_->storage());
    storage_->start();
}

/// Excludes the storage in use from the choice, and starts the build anew in another. False if there is
/// none.
bool ListsCore::replace(const BuildReport& report, const char* why, bool for_ever) {
    const std::optional<Storage> other = tuner_->exclude(in_use_, why, for_ever);
    if (!other) return false;
    tuner_->expect(report.stored + report.dropped);
    use(*other);
    storage_->start();
    return true;
}

bool ListsCore::review(BuildReport& report) {
    if (!tuner_ || in_slices_) return storage_->review(report);
    try {
        const bool complete = storage_->review(report);
        if (!complete || in_use_ != Storage::fixed || report.dropped == 0) return complete;
        // The others drop less, or nothing.
        return !replace(report, "left: a list was longer than slots", false);
    } catch (const UnrepeatableError&) {
        if (!replace(report, "left: the kernel does not repeat itself", true)) throw;
    } catch (const OverflowError&) {
        if (in_use_ != Storage::fixed && options_.overflow == Overflow::stop) throw;
        const std::exception_ptr error = std::current_exception();
        bool replaced = false;
        try {
            replaced = replace(report, "left: the lists did not fit any more", false);
        } catch (const OpenClError&) {
            throw;
        } catch (const Error&) {
            // The others have no room either.
        }
        if (!replaced) std::rethrow_exception(error);
    }
    return false;
}

bool ListsCore::review_may_change() const { return tuner_ || storage_->may_grow(); }

BuildReport ListsCore::measure(const std::function<void()>& insert, Measurement& trial) {
    settle();
    BuildReport report;
    try {
        trial.cost.build_seconds =
            seconds(*device_, [&] { report = finish(*start_build({this}, insert)).front(); });
        trial.stored = report.stored;
        measure_walk(trial);
    } catch (...) {
        empty_after_failure(false);
        throw;
    }
    return report;
}

void ListsCore::measure_walk(Measurement& trial) const {
    std::array<cl_uint, 2> found{};
    Memory findings(device_.state(), found.size(), sizeof(cl_uint), "findings");
    findings.write(found.data(), sizeof found);
    Arguments arguments;
    add_to(arguments);
    arguments.add(cl_uint{walk_most});
    arguments.add(findings.cl());
    const bool words = definitions_.records.back().alignment % sizeof(cl_uint) == 0;
    Kernel& walk = kernel("cellist_walk", kernels::walk_cl,
                          std::string("#define CELLIST_WORD ") + (words ? "uint\n" : "uchar\n"));
    trial.cost.read_seconds = seconds(*device_, [&] { walk.enqueue(cell_range(), arguments); });
    findings.read(found.data(), sizeof found);
    trial.longest = found[0];
}

/// A build, and what Storage::automatic learns from it.
BuildReport ListsCore::build_once(const std::function<void()>& insert) {
    settle();
    if (!tuner_ || !tuner_->on_trial()) {
        const BuildReport report = finish(*start_build({this}, insert)).front();
        if (tuner_) tuner_->built(report.stored);
        return report;
    }
    Measurement trial;
    const Storage tried = tuner_->storage();
    const BuildReport report = measure(insert, trial);
    if (in_use_ == tried)
        tuner_->measured(trial);
    else
        tuner_->built(report.stored);
    return report;
}

BuildReport ListsCore::build(const std::function<void()>& insert) {
    refuse_build();
    const auto self = shared_from_this();
    std::exception_ptr first;
    for (std::size_t tried = 1;; ++tried) {
        try {
            const BuildReport report = build_once(insert);
            refuse_orphan(self);
            return report;
        } catch (const OpenClError& error) {
            if (!first) first = std::current_exception();
            // Drivers may find out in the midst of a build that they have no memory for it. Where all
            // storages fail, the device is lost.
            if (!tuner_ || !out_of_memory(error) || tried == choices.size() ||
                !tuner_->exclude(in_use_,
                                 std::string("left: ") + error.call() + " found no memory"))
                std::rethrow_exception(first);
        }
    }
}

std::string ListsCore::storage_reason() const {
    return tuner_ ? tuner_->reason() : std::string(name_of(in_use_)) + ": named in the options";
}

}  // namespace cellist::detail
