#pragma once

#include <cstdint>
#include <span>

#include <cellist/opencl.hpp>

#include "reference.hpp"

namespace bench {

/// Of the pixels that differ from the reference by more than 1/255, those that do not once layers whose
/// depths float does not tell apart are blended in another order: the proof that it is their order that
/// makes the difference. `samples` are those of a pixel.
[[nodiscard]] std::uint64_t pixels_of_another_order(const oit::Reference& reference,
                                                    std::span<const cl_float4> image, int samples);

}  // namespace bench
