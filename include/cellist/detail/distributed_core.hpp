// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>

namespace cellist::detail {

/// The blocks of all ranks, and the communicator.
class PartitionPlan;

/// Calls a function on all ranks. If it throws on one, all ranks throw the same error. They also
/// throw Error if they pass different names. Collective.
CELLIST_API void on_all_ranks(const PartitionPlan& plan, const std::string& name,
                              const std::function<void()>& call);
template <class Result>
Result on_all_ranks(const PartitionPlan& plan, const std::string& name,
                    const std::function<Result()>& call) {
    std::optional<Result> result;
    on_all_ranks(plan, name, [&] { result.emplace(call()); });
    return std::move(*result);
}

/// Returns the options of a rank's own lists. Throws Error if `options` names other periodic axes
/// than the partition.
[[nodiscard]] CELLIST_API ListsOptions local_options(const PartitionPlan& plan,
                                                     const ListsOptions& options);

/// Distributed lists without the record's C++ type: `local` has the lists of the rank's block and
/// ghost cells.
class CELLIST_API DistributedCore {
public:
    /// Collective. Throws Error if the ranks name different records or options.
    DistributedCore(std::shared_ptr<DeviceState> device, Definitions definitions,
                    std::shared_ptr<const PartitionPlan> plan, const ListsOptions& options,
                    ListsCore& local);
    ~DistributedCore();
    DistributedCore(const DistributedCore&) = delete;
    DistributedCore& operator=(const DistributedCore&) = delete;

    // All functions up to download() are collective.
    BuildReport build(const std::function<void()>& insert);
    BuildReport exchange_ghosts();
    void clear();
    [[nodiscard]] Lengths lengths() const;
    [[nodiscard]] Validation validate() const;
    /// Copies the lists of all ranks. `allocate` takes the number of records, and returns where
    /// they go.
    void download(std::vector<std::uint64_t>& offsets,
                  const std::function<void*(std::uint64_t)>& allocate) const;

    /// Adds what CELLIST_LISTS declares in a program for a distributed container.
    void add_to(Arguments& arguments) const;
    [[nodiscard]] Definitions definitions() const;
    /// Sets the largest size of a message; for tests.
    void set_message_bytes(std::uint64_t bytes);
    /// Sets whether the ranks of a host share memory if they can; for tests.
    void set_shares_memory(bool shares);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cellist::detail
