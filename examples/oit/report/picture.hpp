#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <cellist/opencl.hpp>

#include "frame/frame.hpp"
#include "reference/reference.hpp"

namespace oit {

/// The pictures of all eyes beside one another, row by row, from those behind one another.
[[nodiscard]] std::vector<cl_float4> side_by_side(const std::vector<cl_float4>& image,
                                                  const Frame& frame);

/// The width of all eyes side by side.
[[nodiscard]] int picture_width(const Frame& frame);

/// The reference's image in floats, eye by eye.
[[nodiscard]] std::vector<cl_float4> linear_image(const Reference& reference);

/// The factor by which differences are enlarged in 8-bit pictures.
inline constexpr int difference_factor = 16;

/// The difference of two pictures, channel by channel, of linear colours.
[[nodiscard]] std::vector<cl_float4> linear_difference(std::span<const cl_float4> a,
                                                       std::span<const cl_float4> b);
/// The same for sRGB-encoded colours, times difference_factor, in bytes.
[[nodiscard]] std::vector<std::uint8_t> shown_difference(std::span<const cl_float4> a,
                                                         std::span<const cl_float4> b);

}  // namespace oit
