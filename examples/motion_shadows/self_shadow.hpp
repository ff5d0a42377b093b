// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <cellist/opencl.hpp>

namespace motion {

/// The upper end of Wilson's interval for a probability of which `count` of `trials` were observed,
/// `deviations` from the mean (Wilson, "Probable inference", 1927).
[[nodiscard]] double wilson_upper(double count, double trials, double deviations);

/// The probability of `count` or more of so many trials that each succeed with `probability`.
[[nodiscard]] double binomial_tail(std::uint64_t count, std::uint64_t trials, double probability);

/// Pixels that should be lit, and those of them that are too dark to be so by chance.
struct SelfShadowing {
    std::uint64_t lit = 0;
    std::uint64_t self_shadowed = 0;
};

/// Compares the parts of samples in shadow, which the fourth components of pictures are. A pixel is
/// lit if the probability of a dark sample is less than 5 %: that is the upper end of Wilson's
/// interval for the reference, 4 deviations from the mean. A lit pixel is self-shadowed if the
/// probability of its dark samples, or more, is less than 3.2e-5 (4 deviations) even at that end.
[[nodiscard]] SelfShadowing self_shadowing(std::span<const cl_float4> picture,
                                           std::uint32_t samples,
                                           std::span<const cl_float4> reference,
                                           std::uint32_t moments);

}  // namespace motion
