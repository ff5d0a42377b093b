// SPDX-License-Identifier: MIT
#include "image_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "image.hpp"
#include "ssim.hpp"

namespace support {

ImageDifference difference(std::span<const cl_float4> image, std::span<const glm::dvec3> reference,
                           std::size_t width, std::size_t height) {
    constexpr std::array luma_weights{0.2126, 0.7152, 0.0722};  // of Rec. 709
    ImageDifference result;
    result.errors.resize(image.size());
    std::vector<double> luma(image.size()), reference_luma(image.size());
    double squares = 0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        for (int channel = 0; channel < 3; ++channel) {
            const double is = srgb_from_linear(static_cast<double>(image[p].s[channel]));
            const double should = srgb_from_linear(reference[p][channel]);
            const double error = std::abs(is - should);
            squares += error * error;
            result.errors[p] = std::max(result.errors[p], error);
            const double weight = luma_weights[static_cast<std::size_t>(channel)];
            luma[p] += weight * is;
            reference_luma[p] += weight * should;
        }
        result.max_abs_error = std::max(result.max_abs_error, result.errors[p]);
    }
    result.psnr_db =
        -10 *
        std::log10(squares / (3.0 * static_cast<double>(std::max<std::size_t>(1, image.size()))));
    const std::size_t pixels = width * height;
    for (std::size_t first = 0; first < image.size(); first += pixels)
        result.ssim += mean_ssim(std::span(luma).subspan(first, pixels),
                                 std::span(reference_luma).subspan(first, pixels), width, height) *
                       static_cast<double>(pixels) / static_cast<double>(image.size());
    return result;
}

std::vector<cl_float4> linear_difference(std::span<const cl_float4> a,
                                         std::span<const cl_float4> b) {
    std::vector<cl_float4> result(a.size());
    for (std::size_t p = 0; p < a.size(); ++p)
        for (int c = 0; c < 3; ++c) result[p].s[c] = std::abs(a[p].s[c] - b[p].s[c]);
    return result;
}

std::vector<std::uint8_t> shown_difference(std::span<const cl_float4> a,
                                           std::span<const cl_float4> b) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * a.size());
    for (std::size_t p = 0; p < a.size(); ++p)
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(srgb_from_linear(static_cast<double>(a[p].s[c])) -
                                          srgb_from_linear(static_cast<double>(b[p].s[c])));
            bytes.push_back(static_cast<std::uint8_t>(
                std::lround(255 * std::min(1.0, difference_factor * error))));
        }
    return bytes;
}

void write_difference(const std::filesystem::path& path, std::span<const cl_float4> a,
                      std::span<const cl_float4> b, int width, int height) {
    if (has_floats(image_format(path)))
        write_image(path, linear_difference(a, b), width, height);
    else
        write_bytes_as_image(path, shown_difference(a, b), width, height);
}

}  // namespace support
