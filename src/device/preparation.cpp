// SPDX-License-Identifier: MIT
#include "device/preparation.hpp"

#include <cellist/error.hpp>

namespace cellist::detail {

namespace {

/// Each storage may build in another way the second time.
constexpr int runs_least = 2;
/// A frame that needs more programs than a device keeps compiles in every run.
constexpr int compiling_runs_most = 8;
/// Trials of Storage::automatic take some ten runs.
constexpr int runs_most = 64;

}  // namespace

thread_local Preparation* Preparation::current_ = nullptr;

Preparation::Preparation(const std::function<void(std::size_t)>& progress) : progress_(progress) {
    if (current_ != nullptr) throw Error("prepare() is called by the function that it runs");
    current_ = this;
}

void Preparation::count_program() {
    ++programs_;
    if (progress_) progress_(programs_);
}

void Preparation::run(const std::function<void()>& frame) {
    for (int runs = 1; runs <= runs_most; ++runs) {
        repeats_ = false;
        const std::size_t before = programs_;
        frame();
        const bool is_compiled = programs_ == before || runs >= compiling_runs_most;
        if (runs >= runs_least && is_compiled && !repeats_) return;
    }
}

}  // namespace cellist::detail
