// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <exception>
#include <utility>

#include "device/device_state.hpp"

namespace cellist::detail {

/// Makes calls of OpenCL while other ranks wait for this one: keeps the first error, and then makes
/// no more calls.
class Attempts {
public:
    void make(std::invocable auto&& call) {
        if (error_) return;
        try {
            opencl(call);
        } catch (...) {
            error_ = std::current_exception();
        }
    }
    /// Waits for a command, if there is one, and forgets it.
    void wait_for(cl::Event& event) {
        make([&] {
            if (event() != nullptr) event.wait();
            event = cl::Event();
        });
    }
    /// Returns the error, if there is one, and forgets it.
    [[nodiscard]] std::exception_ptr take() { return std::exchange(error_, nullptr); }

private:
    std::exception_ptr error_;
};

}  // namespace cellist::detail
