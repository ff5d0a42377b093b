// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include <cellist/opencl.hpp>

#include "reference/reference.hpp"

namespace bench {

/// Tries other orders of the layers whose depths float does not tell apart. Calls `use` with the
/// linear colour of the reference's pixel in each order, until it returns true or `most` orders are
/// tried. Returns whether it returned true. `samples` are those of a pixel.
bool any_other_order(const oit::Reference& reference, std::size_t pixel, int samples, int most,
                     const std::function<bool(const glm::dvec3&)>& use);

/// Counts the pixels that differ from the reference by more than 1/255, but not in another order.
/// This proves that the order of layers makes the difference.
[[nodiscard]] std::uint64_t pixels_of_another_order(const oit::Reference& reference,
                                                    std::span<const cl_float4> image, int samples);

}  // namespace bench
