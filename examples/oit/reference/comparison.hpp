// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <cellist/cellist.hpp>

#include "methods/method.hpp"
#include "reference/reference.hpp"

namespace oit {

/// How far a picture from the device is from the reference. Errors are of sRGB-encoded values
/// between 0 and 1, before they are rounded to 8 bits; a pixel's error is that of its worst
/// channel.
struct Comparison {
    double psnr_db = 0;  ///< infinite where the pictures are equal
    double ssim = 0;     ///< mean structural similarity of luma; 1 where the pictures are equal
    double max_abs_error = 0;
    std::uint64_t pixels = 0;
    std::uint64_t pixels_over = 0;              ///< error over 1/255
    std::uint64_t pixels_explained = 0;         ///< of these: depths closer than float resolves
    std::uint64_t pixels_ambiguous = 0;         ///< all pixels with such depths
    std::uint64_t fragments = 0;                ///< of the reference
    std::uint64_t pixels_with_other_count = 0;  ///< pixels whose number of fragments differs
    double max_depth_error = 0;                 ///< relative, over pixels with equal counts
    std::uint64_t pixels_nan = 0;               ///< of the device's image
    bool has_depths = false;                    ///< counts and depths were compared
};

/// `depths` are those that the method stored, if it stores all, and are compared where they are of
/// as many pixels.
[[nodiscard]] Comparison compare(const Reference& reference, std::span<const cl_float4> image,
                                 const std::optional<StoredDepths>& depths);

/// Pixels with a NaN in any channel.
[[nodiscard]] std::uint64_t count_nan(std::span<const cl_float4> image);

}  // namespace oit
