// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <cellist/detail/build.hpp>

#include "device/device_state.hpp"
#include "storage/container_storage.hpp"

namespace cellist::detail {

/// The build whose function this thread runs, and a link to the build around it.
class Build::Running {
public:
    explicit Running(Build& now) : build(now), outer(std::exchange(current, this)) {}
    ~Running() { current = outer; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    static thread_local Running* current;
    Build& build;
    Running* const outer;
};

thread_local Build::Running* Build::Running::current = nullptr;

/// Keeps the containers alive until the caller returns: the function that inserts may replace them.
std::vector<std::shared_ptr<ListsCore>> Build::keep_alive() const {
    std::vector<std::shared_ptr<ListsCore>> kept_alive;
    for (ListsCore* container : containers_) kept_alive.push_back(container->shared_from_this());
    return kept_alive;
}

/// Throws Error if the containers cannot be built together, or not now.
void Build::require_buildable() const {
    const ListsCore& first = *containers_.front();
    for (const ListsCore* container : containers_) {
        container->require_buildable();
        if (std::count(containers_.begin(), containers_.end(), container) > 1)
            throw Error("a build names the same container twice");
        if (container->device() == first.device()) continue;
        const bool same_device = container->device()->device() == first.device()->device();
        if (!same_device || container->device()->context() != first.device()->context())
            throw Error("one build cannot fill the " + first.description() + " on " +
                        first.device()->info.name + " and the " + container->description() +
                        " on " + container->device()->info.name + ": they belong to different " +
                        (same_device ? "contexts" : "devices") + ", so build each of them alone");
    }
}

/// The only place where a build and its containers change from phase to phase, but for failures.
void Build::enter(Phase phase) {
    phase_ = phase;
    for (ListsCore* container : containers_)
        container->enter(
            {.phase = phase, .build = phase == Phase::pending ? shared_from_this() : nullptr});
}

/// Ends the build with the exception under way, or the one given before. All containers have the
/// records then that the build keeps, or are empty.
void Build::fail() noexcept {
    bool without_pool = false;
    if (!error_) {
        error_ = std::current_exception();
        try {
            throw;
        } catch (const OpenClError& error) {
            // A driver may find out only now that it has no memory for a pool it had granted.
            without_pool = out_of_memory(error);
        } catch (...) {}
    }
    phase_ = Phase::failed;
    for (ListsCore* container : containers_) container->fail(without_pool);
}

std::shared_ptr<Build> Build::start(std::vector<ListsCore*> containers,
                                    std::function<void()> insert, Existing existing) {
    const std::shared_ptr<Build> build(new Build(std::move(containers), std::move(insert)));
    build->require_buildable();
    const auto kept_alive = build->keep_alive();
    for (ListsCore* container : build->containers_) {
        count_before_clear(*container);
        container->make_ready();
        container->release_kept_buffers();
    }
    build->reports_.resize(build->containers_.size());
    if (existing == Existing::kept)
        for (ListsCore* container : build->containers_) container->keep_records();
    build->enter(Phase::building);
    try {
        for (ListsCore* container : build->containers_) container->start_build();
        build->enqueue_passes();
    } catch (...) {
        build->fail();
        throw;
    }
    build->enter(Phase::pending);
    return build;
}

/// The containers may have queues of their own, of one context. Of one container, the last read
/// stands for all that was enqueued, so that a build has one command less.
cl::Event Build::enqueue_marker() {
    if (error_) std::rethrow_exception(error_);
    try {
        if (containers_.size() == 1 && bystanders_.empty()) {
            cl::Event read = containers_.front()->storage().in_use().last_read();
            if (read() != nullptr) return read;
        }
        const DeviceState& first = *containers_.front()->device();
        std::vector<cl::Event> others;
        for (const ListsCore* container : containers_) {
            const DeviceState& device = *container->device();
            if (device.queue() == first.queue()) continue;
            others.push_back(device.enqueue_marker());
            opencl([&] { device.queue.flush(); });
        }
        if (others.empty()) return first.enqueue_marker();
        others.push_back(first.enqueue_marker());
        return opencl([&] {
            cl::Event event;
            first.queue.enqueueMarkerWithWaitList(&others, &event);
            return event;
        });
    } catch (...) {
        fail();
        throw;
    }
}

/// Enqueues a pass, and more of them where a container needs no look at the counters in between.
void Build::enqueue_passes() {
    bool another = true;
    while (another) {
        ++passes_;
        for (ListsCore* container : containers_) container->begin_pass();
        {
            const Running running(*this);
            insert_();
        }
        another = false;
        for (ListsCore* container : containers_)
            if (container->storage().in_use().end_pass()) another = true;
    }
    for (const auto& bystander : bystanders_) count_late_inserts(*bystander);
}

void Build::note_bystander(const std::weak_ptr<const ListsCore>& lists,
                           const std::string& parameter, const std::string& kernel) {
    if (Running::current == nullptr) return;
    const std::shared_ptr<const ListsCore> given = lists.lock();
    if (!given) return;
    auto& all = Running::current->build.bystanders_;
    auto known = std::find_if(all.begin(), all.end(), [&](const auto& bystander) {
        return !bystander->counted && bystander->lists.lock() == given;
    });
    if (known == all.end()) {
        auto made = std::make_unique<Bystander>();
        made->first_pass = Running::current->build.passes_;
        made->lists = lists;
        made->description = given->description();
        made->fence.add(given->read_late_inserts(made->before));
        known = all.insert(all.end(), std::move(made));
    }
    const std::string name = parameter.substr(0, parameter.rfind("_nodes"));
    const std::string use = "parameter '" + name + "' of kernel " + kernel;
    auto& uses = (*known)->uses;
    if (std::find(uses.begin(), uses.end(), use) == uses.end()) uses.push_back(use);
}

void Build::count_before_clear(const ListsCore& lists) {
    for (const Running* running = Running::current; running != nullptr; running = running->outer)
        for (const auto& bystander : running->build.bystanders_)
            if (bystander->lists.lock().get() == &lists) count_late_inserts(*bystander);
}

/// Enqueues the reading of the number of late inserts, if the lists still exist.
void Build::count_late_inserts(Bystander& bystander) {
    if (std::exchange(bystander.counted, true)) return;
    if (const auto lists = bystander.lists.lock())
        bystander.fence.add(lists->read_late_inserts(bystander.after));
    else
        bystander.lists.reset();
}

/// Throws Error if lists that are not part of the build have refused inserts of its kernels.
/// Blocks.
void Build::check_bystanders() {
    for (const auto& bystander : std::exchange(bystanders_, {})) {
        bystander->fence.wait();
        const auto [low, high] = bystander->after;
        const std::uint64_t before = wide(bystander->before[0], bystander->before[1]);
        const std::uint64_t after = wide(low, high);
        if (after <= before) continue;
        const std::uint32_t passes = passes_ - bystander->first_pass + 1;
        std::string uses;
        for (const std::string& use : bystander->uses) uses += (uses.empty() ? "" : ", ") + use;
        throw Error("the " + bystander->description + " (" + uses + ") refused " +
                    std::to_string(after - before) + " inserts" +
                    (passes > 1 ? " in " + std::to_string(passes) + " passes" : std::string()) +
                    ", because they are no part of the build: name all containers that the "
                    "kernels fill, as in cellist::build(function, lists, other_lists)");
    }
}

/// Whether all containers are complete; the first blocks.
bool Build::review() {
    check_bystanders();
    bool complete = true;
    for (std::size_t i = 0; i < containers_.size(); ++i) {
        reports_[i].passes = passes_;
        if (!containers_[i]->review(reports_[i])) complete = false;
    }
    return complete;
}

const std::vector<BuildReport>& Build::finish() {
    if (phase_ == Phase::building)
        throw Error("a build is finished by the function that inserts for it");
    if (phase_ == Phase::pending) {
        const auto self = shared_from_this();
        const auto kept_alive = keep_alive();
        enter(Phase::building);
        try {
            while (!review()) enqueue_passes();
        } catch (...) {
            fail();
            throw;
        }
        enter(Phase::ready);
    }
    if (error_) std::rethrow_exception(error_);
    return reports_;
}

void Build::abandon() noexcept {
    if (phase_ != Phase::pending) return;
    const auto self = shared_from_this();
    error_ = std::make_exception_ptr(Error("the lists went before their build was finished"));
    fail();
}

bool Build::may_change() const {
    return std::any_of(containers_.begin(), containers_.end(), [](const ListsCore* container) {
        return container->storage().review_may_change();
    });
}

}  // namespace cellist::detail
