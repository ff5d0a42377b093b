// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace cellist::detail {

/// A call of Device::prepare() by this thread. What the library does then also compiles what other
/// data would need.
class Preparation {
public:
    /// Throws Error if the thread prepares already.
    explicit Preparation(const std::function<void(std::size_t)>& progress);
    ~Preparation() { current_ = nullptr; }
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    /// Null if this thread does not prepare.
    [[nodiscard]] static Preparation* current() { return current_; }

    /// A program was built or loaded. Calls the user's function.
    void count_program();
    /// Asks for another run of the frame.
    void repeat() { repeats_ = true; }

    /// Runs the frame as often as needed.
    void run(const std::function<void()>& frame);

private:
    static thread_local Preparation* current_;

    const std::function<void(std::size_t)>& progress_;
    std::size_t programs_ = 0;
    bool repeats_ = false;
};

}  // namespace cellist::detail
