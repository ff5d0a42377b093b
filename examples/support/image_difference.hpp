#pragma once

#include <cstddef>
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

}  // namespace support
