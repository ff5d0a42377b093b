#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include <cellist/opencl.hpp>

#include "reference/reference.hpp"

namespace bench {

/// Calls `use` with the linear colour of a pixel of the reference in each other order of those layers whose
/// depths float does not tell apart, until it returns true or `most` orders are tried. Whether it did.
/// `samples` are those of a pixel.
bool any_other_order(const oit::Reference& reference, std::size_t pixel, int samples, int most,
                     const std::function<bool(const glm::dvec3&)>& use);

/// Of the pixels that differ from the reference by more than 1/255, those that do not in another order:
/// the proof that it is the order of layers that makes the difference.
[[nodiscard]] std::uint64_t pixels_of_another_order(const oit::Reference& reference,
                                                    std::span<const cl_float4> image, int samples);

}  // namespace bench
