// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <cellist/options.hpp>
#include <cellist/report.hpp>

#include "device/record_kernels.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

/// The storage of a container: here the one that the options name. AutomaticStorage changes it from
/// build to build.
class ContainerStorage {
public:
    ContainerStorage(RecordKernels& kernels, std::unique_ptr<ListStorage> storage)
        : kernels_(kernels), storage_(std::move(storage)) {}
    virtual ~ContainerStorage() = default;
    ContainerStorage(const ContainerStorage&) = delete;
    ContainerStorage& operator=(const ContainerStorage&) = delete;

    /// The storage in use.
    [[nodiscard]] ListStorage& in_use() const { return *storage_; }
    /// Puts another storage in the place of the one in use, and returns that.
    [[nodiscard]] std::unique_ptr<ListStorage> exchange(std::unique_ptr<ListStorage> other) {
        return std::exchange(storage_, std::move(other));
    }

    /// Chooses the storage that another container with the same options has chosen.
    virtual void adopt_choice([[maybe_unused]] const ContainerStorage& other) {}
    /// A build of this container alone that blocks; `run` does all of it. A hook: AutomaticStorage
    /// measures and retries here.
    virtual BuildReport build(const std::function<BuildReport()>& run) { return run(); }
    /// Starts a build in the storage in use.
    virtual void start() { storage_->start({}); }
    /// As ListStorage::review(), for a build that start() began.
    virtual bool review(BuildReport& report) { return storage_->review(report); }
    /// Whether review() can change the lists.
    [[nodiscard]] virtual bool review_may_change() const { return storage_->may_grow(); }
    /// From now on until end_slices(), the storage stays the same.
    virtual void begin_slices() {}
    virtual void end_slices() { storage_->set_slice({0, storage_->cells()}); }
    /// A sentence for people: why this storage is in use.
    [[nodiscard]] virtual std::string reason() const;

    [[nodiscard]] RecordKernels& kernels() const { return kernels_; }

protected:
    RecordKernels& kernels_;
    std::unique_ptr<ListStorage> storage_;
};

}  // namespace cellist::detail
