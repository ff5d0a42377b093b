#include "build.hpp"

#include <algorithm>
#include <utility>

#include <cellist/detail/lists_core.hpp>

namespace cellist::detail {

/// The build whose function this thread runs, and a link to the build around it.
class Build::Running {
public:
    explicit Running(Build& now) : build(now), outer(std::exchange(innermost, this)) {}
    ~Running() { innermost = outer; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    static thread_local Running* innermost;
    Build& build;
    Running* const outer;
};

thread_local Build::Running* Build::Running::innermost = nullptr;

/// Runs a part of the build; whatever goes wrong in it leaves all containers empty.
template <class Step>
void Build::guarded(Step step) {
    try {
        step();
    } catch (const OpenClError& error) {
        // A driver may find out only now that it has no memory for a pool it had granted.
        fail(out_of_memory(error));
        throw;
    } catch (...) {
        fail(false);
        throw;
    }
}

/// `without_pool` gives the nodes' memory back; the next build grows anew.
void Build::fail(bool without_pool) noexcept {
    finished_ = true;
    error_ = std::current_exception();
    for (ListsCore* container : containers_) {
        container->set_pending(nullptr);
        container->empty_after_failure(without_pool);
    }
}

/// Keeps the containers alive until the caller returns: the function that inserts may replace them.
std::vector<std::shared_ptr<ListsCore>> Build::held() const {
    std::vector<std::shared_ptr<ListsCore>> held;
    for (ListsCore* container : containers_) held.push_back(container->shared_from_this());
    return held;
}

void Build::enqueue() {
    const auto held = this->held();
    for (std::size_t i = 0; i < containers_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (containers_[i] == containers_[j])
                throw Error("a build names the same container twice");
    for (ListsCore* container : containers_) {
        take_counts(*container);
        container->settle();
    }
    reports_.resize(containers_.size());
    guarded([&] {
        for (ListsCore* container : containers_) container->start();
        enqueue_passes();
    });
    for (ListsCore* container : containers_) container->set_pending(shared_from_this());
}

cl::Event Build::marker() {
    if (error_) std::rethrow_exception(error_);
    cl::Event event;
    guarded([&] { event = ListsCore::marker_of(containers_); });
    return event;
}

/// Enqueues a pass, and more of them where a container needs no look at the counters in between.
void Build::enqueue_passes() {
    bool another = true;
    while (another) {
        ++passes_;
        for (ListsCore* container : containers_) container->storage().begin_pass();
        {
            const Running running(*this);
            insert_();
        }
        another = false;
        for (ListsCore* container : containers_)
            if (container->storage().end_pass()) another = true;
    }
    for (const auto& bystander : bystanders_) count_refused(*bystander);
}

void Build::give(const std::weak_ptr<const ListsCore>& lists, const std::string& parameter,
                 const std::string& kernel) {
    if (Running::innermost == nullptr) return;
    const std::shared_ptr<const ListsCore> given = lists.lock();
    if (!given) return;
    auto& all = Running::innermost->build.bystanders_;
    auto known = std::find_if(all.begin(), all.end(), [&](const auto& bystander) {
        return !bystander->counted && bystander->lists.lock() == given;
    });
    if (known == all.end()) {
        auto made = std::make_unique<Bystander>();
        made->first_pass = Running::innermost->build.passes_;
        made->lists = lists;
        made->description = given->description();
        made->fence = given->read_late(made->before);
        known = all.insert(all.end(), std::move(made));
    }
    const std::string name = parameter.substr(0, parameter.rfind("_nodes"));
    const std::string use = "parameter '" + name + "' of kernel " + kernel;
    auto& uses = (*known)->uses;
    if (std::find(uses.begin(), uses.end(), use) == uses.end()) uses.push_back(use);
}

void Build::take_counts(const ListsCore& lists) {
    for (const Running* running = Running::innermost; running != nullptr; running = running->outer)
        for (const auto& bystander : running->build.bystanders_)
            if (bystander->lists.lock().get() == &lists) count_refused(*bystander);
}

/// Enqueues the reading of the number of inserts that the lists have refused, if the lists still exist.
void Build::count_refused(Bystander& bystander) {
    if (std::exchange(bystander.counted, true)) return;
    if (const auto lists = bystander.lists.lock())
        bystander.fence = lists->read_late(bystander.after);
    else
        bystander.lists.reset();
}

/// Throws Error if lists that are not part of the build have refused inserts of its kernels. Blocks.
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

void Build::run_to_end() {
    for (;;) {
        check_bystanders();
        bool complete = true;
        for (std::size_t i = 0; i < containers_.size(); ++i) {
            reports_[i].passes = passes_;
            if (!containers_[i]->review(reports_[i])) complete = false;
        }
        if (complete) return;
        enqueue_passes();
    }
}

const std::vector<BuildReport>& Build::finish() {
    if (!finished_) {
        const auto self = shared_from_this();
        const auto held = this->held();
        for (ListsCore* container : containers_) container->set_pending(nullptr);
        guarded([&] { run_to_end(); });
        finished_ = true;
    }
    if (error_) std::rethrow_exception(error_);
    return reports_;
}

void Build::abandon() noexcept {
    if (finished_) return;
    finished_ = true;
    const auto self = shared_from_this();
    error_ = std::make_exception_ptr(Error("the lists went before their build was finished"));
    for (ListsCore* container : containers_) {
        container->set_pending(nullptr);
        container->empty_after_failure(false);
    }
}

bool Build::may_change() const {
    for (const ListsCore* container : containers_)
        if (container->review_may_change()) return true;
    return false;
}

}  // namespace cellist::detail
