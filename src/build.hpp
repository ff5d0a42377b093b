#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <vector>

#include <cellist/report.hpp>

#include "storage.hpp"

namespace cellist::detail {

class ListsCore;

/// A build of one or more containers: passes over the user's kernels until every container is
/// complete. Enqueues as many passes as need no look at the counters; finish() does the rest.
class Build : public std::enable_shared_from_this<Build> {
public:
    /// `insert` runs the kernels that fill the containers.
    Build(std::vector<ListsCore*> containers, std::function<void()> insert)
        : containers_(std::move(containers)), insert_(std::move(insert)) {}

    /// Enqueues the first passes. Throws what `insert` throws; the containers are empty then. Does not
    /// block.
    void enqueue();
    /// Completes when what was enqueued so far has. The build has failed where this throws.
    [[nodiscard]] cl::Event marker();
    /// The reports, after all passes. Throws the same every time if the build failed; the containers
    /// are empty then. Blocks.
    const std::vector<BuildReport>& finish();
    /// Ends a build whose containers are about to go. Blocks.
    void abandon() noexcept;
    /// Whether finish() can change the lists.
    [[nodiscard]] bool may_change() const;

private:
    void enqueue_passes();
    void run_to_end();
    void fail(bool without_pool) noexcept;
    template <class Step>
    void guarded(Step step);

    std::vector<ListsCore*> containers_;
    std::function<void()> insert_;
    std::vector<BuildReport> reports_;
    std::uint32_t passes_ = 0;
    bool finished_ = false;
    std::exception_ptr error_;
};

}  // namespace cellist::detail
