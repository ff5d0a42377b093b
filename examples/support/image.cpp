#include "image.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include <stb_image_write.h>

#include "input_error.hpp"

namespace support {

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

}  // namespace

std::vector<std::uint8_t> srgb_bytes(std::span<const cl_float4> pixels) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(pixels.size() * 3);
    for (const cl_float4& pixel : pixels)
        for (int channel = 0; channel < 3; ++channel) {
            const double encoded = srgb_from_linear(static_cast<double>(pixel.s[channel]));
            const double dither = noise(static_cast<std::uint32_t>(bytes.size()));
            bytes.push_back(static_cast<std::uint8_t>(std::min(255.0, 255 * encoded + dither)));
        }
    return bytes;
}

std::string png(std::span<const std::uint8_t> bytes, int width, int height) {
    std::string file;
    const auto append = [](void* to, void* data, int count) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                              static_cast<std::size_t>(count));
    };
    if (stbi_write_png_to_func(append, &file, width, height, 3, bytes.data(), 3 * width) == 0)
        throw std::bad_alloc();
    return file;
}

void write_png(const std::filesystem::path& path, std::span<const cl_float4> pixels, int width,
               int height) {
    const std::vector<std::uint8_t> bytes = srgb_bytes(pixels);
    if (stbi_write_png(path.string().c_str(), width, height, 3, bytes.data(), 3 * width) == 0)
        throw InputError("cannot write '" + path.string() + "'");
}

}  // namespace support
