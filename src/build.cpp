#include "build.hpp"

#include <cellist/detail/lists_core.hpp>

namespace cellist::detail {

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

void Build::enqueue() {
    for (std::size_t i = 0; i < containers_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (containers_[i] == containers_[j])
                throw Error("a build names the same container twice");
    for (ListsCore* container : containers_) container->settle();
    reports_.resize(containers_.size());
    guarded([&] {
        for (ListsCore* container : containers_) container->start();
        enqueue_passes();
    });
    for (ListsCore* container : containers_) container->set_pending(shared_from_this());
}

cl::Event Build::marker() {
    cl::Event event;
    guarded([&] { event = containers_.front()->marker(); });
    return event;
}

/// Enqueues a pass, and more of them where a container needs no look at the counters in between.
void Build::enqueue_passes() {
    bool another = true;
    while (another) {
        ++passes_;
        for (ListsCore* container : containers_) container->storage().begin_pass();
        insert_();
        another = false;
        for (ListsCore* container : containers_)
            if (container->storage().end_pass()) another = true;
    }
}

void Build::run_to_end() {
    for (;;) {
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
