// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <cellist/opencl.hpp>

namespace support {

/// Images of width x height pixels beside one another, row by row from the top. `image` has one
/// after the other.
template <class Pixel>
[[nodiscard]] std::vector<Pixel> side_by_side(const std::vector<Pixel>& image, int width,
                                              int height, std::size_t images);

/// The sRGB encoding of a linear value, both clamped to 0 ... 1. NaN becomes 0.
[[nodiscard]] double srgb_from_linear(double linear);

/// Red, green and blue of linear pixels in 8-bit sRGB. Dithers pixels that equal a neighbour in
/// their row, so that backgrounds show no bands: the mean over many pixels is right, and the error
/// of a byte is less than 1. Rounds all other pixels. Equal images make equal bytes.
[[nodiscard]] std::vector<std::uint8_t> srgb_bytes(std::span<const cl_float4> pixels, int width);

/// The bytes of a PNG file with an image of 3 bytes a pixel, row by row from the top.
[[nodiscard]] std::string png(std::span<const std::uint8_t> bytes, int width, int height);

/// The bytes of an OpenEXR file with red, green and blue as 32-bit floats, one part of uncompressed
/// scan lines: "Technical Introduction to OpenEXR" and "OpenEXR File Layout". Rows from the top.
[[nodiscard]] std::string exr(std::span<const cl_float4> pixels, int width, int height);

/// The bytes of a PFM file ("Portable FloatMap", Debevec): red, green and blue as 32-bit floats,
/// little endian. Rows from the top.
[[nodiscard]] std::string pfm(std::span<const cl_float4> pixels, int width, int height);

/// What an image file holds.
enum class ImageFormat {
    png,   ///< 8-bit sRGB
    jpeg,  ///< 8-bit sRGB, quality 95
    pfm,   ///< linear floats
    exr,   ///< linear floats
};

/// The format of a file by its extension: .png, .jpg or .jpeg, .pfm, .exr, in upper or lower case.
/// PNG for stdout and for anything but a regular file. For any other extension, throws InputError
/// with a list of these.
[[nodiscard]] ImageFormat image_format(const std::filesystem::path& path);

[[nodiscard]] inline bool has_floats(ImageFormat format) {
    return format == ImageFormat::pfm || format == ImageFormat::exr;
}

/// Writes an image of 3 bytes a pixel as PNG or JPEG, as the file's name says. Throws as
/// write_file() does.
void write_bytes_as_image(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                          int width, int height);

/// Writes linear RGB pixels (the fourth component is not used), row by row from the top, in the
/// format of the file's name. Throws as write_file() does.
void write_image(const std::filesystem::path& path, std::span<const cl_float4> pixels, int width,
                 int height);

}  // namespace support

// ---- implementation

template <class Pixel>
std::vector<Pixel> support::side_by_side(const std::vector<Pixel>& image, int width, int height,
                                         std::size_t images) {
    const auto columns = static_cast<std::size_t>(width), lines = static_cast<std::size_t>(height);
    std::vector<Pixel> rows;
    rows.reserve(image.size());
    for (std::size_t y = 0; y < lines; ++y)
        for (std::size_t i = 0; i < images; ++i) {
            const auto row = image.begin() + static_cast<std::ptrdiff_t>((i * lines + y) * columns);
            rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(columns));
        }
    return rows;
}
