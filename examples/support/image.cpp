// SPDX-License-Identifier: MIT
#include "image.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include <stb_image_write.h>

#include "files.hpp"
#include "input_error.hpp"

namespace support {
namespace {

constexpr std::pair<std::string_view, ImageFormat> extensions[] = {{".png", ImageFormat::png},
                                                                   {".jpg", ImageFormat::jpeg},
                                                                   {".jpeg", ImageFormat::jpeg},
                                                                   {".pfm", ImageFormat::pfm},
                                                                   {".exr", ImageFormat::exr}};

void append(void* to, void* data, int count) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                          static_cast<std::size_t>(count));
}

std::string jpeg(std::span<const std::uint8_t> bytes, int width, int height) {
    constexpr int quality = 95;
    std::string file;
    if (stbi_write_jpg_to_func(append, &file, width, height, 3, bytes.data(), quality) == 0)
        throw std::bad_alloc();
    return file;
}

}  // namespace

double srgb_from_linear(double linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

namespace {

// Evenly distributed in [0, 1), from a counter (PCG hash).
double noise(std::uint32_t counter) {
    const std::uint32_t state = counter * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737U;
    return static_cast<double>((word >> 22) ^ word) * 0x1p-32;
}

bool are_equal(const cl_float4& a, const cl_float4& b) {
    return a.s[0] == b.s[0] && a.s[1] == b.s[1] && a.s[2] == b.s[2];
}

}  // namespace

std::vector<std::uint8_t> srgb_bytes(std::span<const cl_float4> pixels, int width) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(pixels.size() * 3);
    const auto row = static_cast<std::size_t>(width);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const bool is_flat = (i % row > 0 && are_equal(pixels[i], pixels[i - 1])) ||
                             ((i + 1) % row > 0 && are_equal(pixels[i], pixels[i + 1]));
        for (const cl_float value : {pixels[i].s[0], pixels[i].s[1], pixels[i].s[2]}) {
            const double encoded = srgb_from_linear(static_cast<double>(value));
            const double up = is_flat ? noise(static_cast<std::uint32_t>(bytes.size())) : 0.5;
            bytes.push_back(static_cast<std::uint8_t>(std::min(255.0, 255 * encoded + up)));
        }
    }
    return bytes;
}

std::string png(std::span<const std::uint8_t> bytes, int width, int height) {
    std::string file;
    if (stbi_write_png_to_func(append, &file, width, height, 3, bytes.data(), 3 * width) == 0)
        throw std::bad_alloc();
    return file;
}

std::string pfm(std::span<const cl_float4> pixels, int width, int height) {
    // The scale is negative where the bytes are little endian.
    std::string file = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
    const auto columns = static_cast<std::size_t>(width);
    for (std::size_t rows = static_cast<std::size_t>(height); rows-- > 0;)  // from the bottom
        for (const cl_float4& pixel : pixels.subspan(rows * columns, columns))
            file.append(reinterpret_cast<const char*>(pixel.s), 3 * sizeof(float));
    return file;
}

ImageFormat image_format(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    for (const auto& [known, format] : extensions)
        if (extension == known) return format;
    std::error_code error;
    const bool is_file = !std::filesystem::exists(path, error) ||
                         std::filesystem::is_regular_file(path, error) ||
                         std::filesystem::is_directory(path, error);
    if (is_file && !is_standard_output(path))
        throw InputError("cannot write '" + text_of(path) +
                         "': the name of a picture ends in .png, .jpg, .jpeg, .pfm or .exr");
    return ImageFormat::png;
}

void write_bytes_as_image(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                          int width, int height) {
    const bool is_jpeg = image_format(path) == ImageFormat::jpeg;
    write_file(path, is_jpeg ? jpeg(bytes, width, height) : png(bytes, width, height));
}

void write_image(const std::filesystem::path& path, std::span<const cl_float4> pixels, int width,
                 int height) {
    const ImageFormat format = image_format(path);
    if (format == ImageFormat::pfm)
        write_file(path, pfm(pixels, width, height));
    else if (format == ImageFormat::exr)
        write_file(path, exr(pixels, width, height));
    else
        write_bytes_as_image(path, srgb_bytes(pixels, width), width, height);
}

}  // namespace support
