#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <cellist/opencl.hpp>

namespace support {

/// The sRGB encoding of a linear value, both clamped to 0 ... 1. NaN becomes 0.
[[nodiscard]] double srgb_from_linear(double linear);

/// Red, green and blue of linear pixels in 8-bit sRGB, dithered so that gradients show no bands: the
/// mean over many pixels is right, and a byte is off by less than 1. Depends on a pixel's value and
/// index alone.
[[nodiscard]] std::vector<std::uint8_t> srgb_bytes(std::span<const cl_float4> pixels);

/// The bytes of a PNG file with an image of 3 bytes a pixel, row by row from the top.
[[nodiscard]] std::string png(std::span<const std::uint8_t> bytes, int width, int height);

/// Writes linear RGB pixels (the fourth component is not used), row by row from the top, as an
/// 8-bit sRGB PNG. Throws InputError where the file cannot be written.
void write_png(const std::filesystem::path& path, std::span<const cl_float4> pixels, int width,
               int height);

}  // namespace support
