#pragma once

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

}  // namespace oit
