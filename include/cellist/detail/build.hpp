// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/report.hpp>

namespace cellist::detail {

/// What happens to the records that are in the containers before a build.
enum class Existing { cleared, kept };

/// A build of one or more containers: passes over the user's kernels until every container is
/// complete. start() enqueues the passes that need no look at the counters; finish() does the rest.
class CELLIST_API Build : public std::enable_shared_from_this<Build> {
public:
    /// Enqueues the first passes: `insert` runs the kernels that fill the containers. Throws what
    /// `insert` throws; the containers have their existing records then, or are empty. Throws Error
    /// if the containers cannot be built together. Does not block.
    [[nodiscard]] static std::shared_ptr<Build> start(std::vector<ListsCore*> containers,
                                                      std::function<void()> insert,
                                                      Existing existing = Existing::cleared);
    /// Completes when everything has that was enqueued so far. The build has failed if this throws.
    [[nodiscard]] cl::Event enqueue_marker();
    /// The reports, after all passes. Throws the same every time if the build failed; the
    /// containers have their existing records then, or are empty. Blocks.
    const std::vector<BuildReport>& finish();
    /// Ends a pending build of containers that are about to go. Blocks.
    void abandon() noexcept;
    /// Whether finish() can change the lists.
    [[nodiscard]] bool may_change() const;

    /// Call this before a kernel that takes closed lists. Tells the build whose function this
    /// thread runs, if any, about the lists and the parameter that takes their nodes.
    static void note_bystander(const std::weak_ptr<const ListsCore>& lists,
                               const std::string& parameter, const std::string& kernel);
    /// Call this before the counters of a container are cleared: the builds whose functions this
    /// thread runs read its late inserts first.
    static void count_before_clear(const ListsCore& lists);

private:
    /// Lists that kernels of the build take and that are not part of it. Records that they refuse
    /// would be lost silently.
    struct Bystander {
        std::weak_ptr<const ListsCore> lists;
        std::string description;
        std::vector<std::string> uses;  ///< by kernels
        std::uint32_t first_pass = 0;
        std::array<cl_uint, 2> before{};  ///< late inserts, low and high word
        std::array<cl_uint, 2> after{};
        bool counted = false;  ///< `after` is on its way
        ReadbackFence fence;
    };
    class Running;

    Build(std::vector<ListsCore*> containers, std::function<void()> insert)
        : containers_(std::move(containers)), insert_(std::move(insert)) {}

    void require_buildable() const;
    [[nodiscard]] std::vector<std::shared_ptr<ListsCore>> keep_alive() const;
    void enter(Phase phase);
    void fail() noexcept;
    void enqueue_passes();
    [[nodiscard]] bool review();
    static void count_late_inserts(Bystander& bystander);
    void check_bystanders();

    std::vector<ListsCore*> containers_;
    std::function<void()> insert_;
    std::vector<BuildReport> reports_;
    std::vector<std::unique_ptr<Bystander>> bystanders_;  ///< of the passes since the last review
    std::uint32_t passes_ = 0;
    Phase phase_ = Phase::ready;  ///< as of the containers, but these may end first
    std::exception_ptr error_;    ///< that the build failed with
};

}  // namespace cellist::detail
