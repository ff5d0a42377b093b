#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "methods/method.hpp"

namespace oit {

// The methods that add fragments up in any order: see accumulate.clh.

/// A method's source behind what they share.
[[nodiscard]] std::string accumulating_text(std::string_view source);

/// They know surfaces that cover what is behind them.
[[nodiscard]] std::string accumulating_refusal(const Frame& frame, const Needs& needs);

/// Throws InputError where the device has no atomic addition of 64 bits.
void require_wide_sums(const cellist::Device& device);

template <class Accumulating>
std::unique_ptr<Method> make_accumulating(FragmentSource& source) {
    require_wide_sums(source.device());
    return std::make_unique<Accumulating>(source);
}

}  // namespace oit
