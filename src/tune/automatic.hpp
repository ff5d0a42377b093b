// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "storage/container_storage.hpp"
#include "tune/storage_tuner.hpp"

namespace cellist::detail {

/// Storage::automatic: measures builds, and puts the storage in place that the tuner chooses.
class AutomaticStorage final : public ContainerStorage {
public:
    AutomaticStorage(RecordKernels& kernels, const Shape& shape, const ListsOptions& options);

    /// Measures the build if the tuner asks for it. Where a driver finds no memory, another storage
    /// tries.
    BuildReport build(const std::function<BuildReport()>& run) override;
    void adopt_choice(const ContainerStorage& other) override;
    void start() override;
    /// Where the storage in use fails and another may not, that takes its place. The lists are not
    /// complete then.
    bool review(BuildReport& report) override;
    [[nodiscard]] bool review_may_change() const override { return true; }
    void begin_slices() override;
    void end_slices() override;
    [[nodiscard]] std::string reason() const override { return tuner_.reason(); }

    [[nodiscard]] StorageTuner& tuner() { return tuner_; }

private:
    BuildReport build_once(const std::function<BuildReport()>& run);
    void use(Storage storage);
    bool replace(const BuildReport& report, const char* why, StorageTuner::Exclusion exclusion);

    Shape shape_;
    ListsOptions options_;
    StorageTuner tuner_;
    std::optional<Storage> in_place_;  ///< with its pool; none where the last change has failed
    bool in_slices_ = false;
};

/// What the options name, with empty lists. Throws Error if a size exceeds a limit.
[[nodiscard]] std::unique_ptr<ContainerStorage> make_container_storage(RecordKernels& kernels,
                                                                       const Shape& shape,
                                                                       const ListsOptions& options);

}  // namespace cellist::detail
