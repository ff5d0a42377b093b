// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "methods/method.hpp"

namespace oit {

// The methods that draw the scene once for each layer: see peeling_common.clh.

inline constexpr cl_ulong first_key = 0;
inline constexpr cl_ulong last_key = ~cl_ulong{0};

/// A method's source, after what they share.
[[nodiscard]] std::string peeling_text(std::string_view source);

/// They blend all samples of a pixel at once, and one fragment after the other.
[[nodiscard]] std::string peeling_refusal(const Frame& frame, const FrameFeatures& features);

/// Throws InputError where the device has no atomic minimum of 64 bits.
void require_wide_atomics(const cellist::Device& device, std::string_view what);

template <class Peeling>
std::unique_ptr<Method> make_peeling(FragmentSource& source) {
    require_wide_atomics(source.device(), "peeling");
    return std::make_unique<Peeling>(source);
}

}  // namespace oit
