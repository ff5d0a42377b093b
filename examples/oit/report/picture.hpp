// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <cellist/opencl.hpp>

#include "frame/frame.hpp"
#include "image.hpp"
#include "reference/reference.hpp"

namespace oit {

/// The pictures of all eyes beside one another, row by row, from those behind one another.
template <class Pixel>
[[nodiscard]] std::vector<Pixel> side_by_side(const std::vector<Pixel>& image, const Frame& frame);

/// The width of all eyes side by side.
[[nodiscard]] int picture_width(const Frame& frame);

/// The reference's image in floats, eye by eye.
[[nodiscard]] std::vector<cl_float4> linear_image(const Reference& reference);

/// Writes a heat map of the number of layers in each pixel of the frame, all eyes side by side.
/// `layers` are eye by eye. Throws as support::write_file() does.
void write_layers(const std::filesystem::path& path, const std::vector<cl_uint>& layers,
                  const Frame& frame);

}  // namespace oit

// ---- implementation

template <class Pixel>
std::vector<Pixel> oit::side_by_side(const std::vector<Pixel>& image, const Frame& frame) {
    return support::side_by_side(image, frame.width(), frame.height(), frame.views.size());
}
