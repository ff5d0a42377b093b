// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <cellist/error.hpp>

namespace cellist::detail {

/// A pointer from an object of a movable class to what it owns. Every use after a move throws
/// Error.
template <class Pointer>
class Owned {
public:
    /// `what` names an object of the class, e.g. "a Kernel".
    explicit Owned(const char* what, Pointer pointer = nullptr)
        : pointer_(std::move(pointer)), what_(what) {}

    [[nodiscard]] const Pointer& pointer() const {
        if (!pointer_) throw Error(std::string(what_) + " is used after it was moved from");
        return pointer_;
    }
    [[nodiscard]] auto* get() const { return pointer().get(); }
    auto* operator->() const { return get(); }
    auto& operator*() const { return *get(); }

private:
    Pointer pointer_;
    const char* what_;
};

}  // namespace cellist::detail
