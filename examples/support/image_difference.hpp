// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include <cellist/opencl.hpp>

namespace support {

/// How far pictures are from others. Errors are of sRGB-encoded values between 0 and 1, before they
/// are rounded to 8 bits; a pixel's error is that of its worst channel.
struct ImageDifference {
    double psnr_db = 0;  ///< infinite where the pictures are equal
    double ssim = 0;     ///< mean structural similarity of luma; 1 where the pictures are equal
    double max_abs_error = 0;
    std::vector<double> errors;  ///< of each pixel
};

/// Compares linear pictures of width x height pixels, one after the other.
[[nodiscard]] ImageDifference difference(std::span<const cl_float4> image,
                                         std::span<const glm::dvec3> reference, std::size_t width,
                                         std::size_t height);

/// The factor by which differences are enlarged in 8-bit pictures.
inline constexpr int difference_factor = 16;

/// The difference of two pictures, channel by channel, of linear colours.
[[nodiscard]] std::vector<cl_float4> linear_difference(std::span<const cl_float4> a,
                                                       std::span<const cl_float4> b);
/// The same for sRGB-encoded colours, times difference_factor, in bytes.
[[nodiscard]] std::vector<std::uint8_t> shown_difference(std::span<const cl_float4> a,
                                                         std::span<const cl_float4> b);

/// Writes linear_difference() in a format of floats, and else shown_difference(). Throws as
/// write_file() does.
void write_difference(const std::filesystem::path& path, std::span<const cl_float4> a,
                      std::span<const cl_float4> b, int width, int height);

}  // namespace support
