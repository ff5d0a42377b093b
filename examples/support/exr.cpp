// SPDX-License-Identifier: MIT
// Writes OpenEXR files: a header of attributes, the offsets of all lines, and the lines. Each line
// has its channels one after the other. All numbers are little endian.
#include <bit>
#include <cstring>
#include <limits>
#include <string_view>

#include "image.hpp"

namespace support {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& file, T value) {
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_text(std::string& file, std::string_view text) { file.append(text).push_back('\0'); }

void append_attribute(std::string& file, std::string_view name, std::string_view type,
                      std::string_view value) {
    append_text(file, name);
    append_text(file, type);
    append(file, static_cast<std::int32_t>(value.size()));
    file += value;
}

template <class... T>
std::string bytes_of(T... values) {
    std::string bytes;
    (append(bytes, values), ...);
    return bytes;
}

// Channels are in the order of their names.
constexpr struct {
    std::string_view name;
    int component;
} channels[] = {{"B", 2}, {"G", 1}, {"R", 0}};

std::string channel_list() {
    constexpr std::int32_t type_float = 2, every = 1;
    std::string list;
    for (const auto& channel : channels) {
        append_text(list, channel.name);
        // pLinear and three bytes that are not used are 0.
        list += bytes_of(type_float, std::int32_t{0}, every, every);
    }
    list.push_back('\0');
    return list;
}

std::string header(int width, int height) {
    constexpr std::int32_t magic = 20000630, version = 2;
    const std::string window = bytes_of(std::int32_t{0}, std::int32_t{0}, std::int32_t{width - 1},
                                        std::int32_t{height - 1});
    std::string file = bytes_of(magic, version);
    append_attribute(file, "channels", "chlist", channel_list());
    append_attribute(file, "compression", "compression", bytes_of(std::uint8_t{0}));
    append_attribute(file, "dataWindow", "box2i", window);
    append_attribute(file, "displayWindow", "box2i", window);
    append_attribute(file, "lineOrder", "lineOrder", bytes_of(std::uint8_t{0}));
    append_attribute(file, "pixelAspectRatio", "float", bytes_of(1.0F));
    append_attribute(file, "screenWindowCenter", "v2f", bytes_of(0.0F, 0.0F));
    append_attribute(file, "screenWindowWidth", "float", bytes_of(1.0F));
    file.push_back('\0');
    return file;
}

}  // namespace

std::string exr(std::span<const cl_float4> pixels, int width, int height) {
    std::string file = header(width, height);
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    const std::size_t line_bytes = std::size(channels) * columns * sizeof(float);
    const std::uint64_t lines_at = file.size() + rows * sizeof(std::uint64_t);
    for (std::size_t y = 0; y < rows; ++y)
        append(file, std::uint64_t{lines_at + y * (2 * sizeof(std::int32_t) + line_bytes)});
    for (std::size_t y = 0; y < rows; ++y) {
        append(file, static_cast<std::int32_t>(y));
        append(file, static_cast<std::int32_t>(line_bytes));
        for (const auto& channel : channels)
            for (const cl_float4& pixel : pixels.subspan(y * columns, columns))
                append(file, pixel.s[channel.component]);
    }
    return file;
}

}  // namespace support
