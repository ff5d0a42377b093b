// SPDX-License-Identifier: MIT
#include "heat_map.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <cellist/opencl.hpp>

#include "image.hpp"
#include "number_text.hpp"

namespace support {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr std::array<Colour, 10> heat_colours{{{0x00, 0x00, 0x04},
                                               {0x1B, 0x0C, 0x42},
                                               {0x4B, 0x0C, 0x6B},
                                               {0x78, 0x1C, 0x6D},
                                               {0xA5, 0x2C, 0x60},
                                               {0xCF, 0x44, 0x46},
                                               {0xED, 0x69, 0x25},
                                               {0xFB, 0x9A, 0x06},
                                               {0xF7, 0xD0, 0x3C},
                                               {0xFC, 0xFF, 0xA4}}};
constexpr Colour background{40, 40, 40}, ink{255, 255, 255};

// Characters have 3 x 5 dots, row by row from the lowest bit.
constexpr std::string_view drawn_characters = "0123456789-.ABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::array<unsigned, drawn_characters.size()> character_dots{
    0x7B6F, 0x749A, 0x73E7, 0x79E7, 0x49ED, 0x79CF, 0x7BCF, 0x4927, 0x7BEF, 0x79EF,
    0x01C0, 0x2000, 0x5BEA, 0x3AEB, 0x624E, 0x3B6B, 0x72CF, 0x12CF, 0x6B4E, 0x5BED,
    0x7497, 0x2B24, 0x5AED, 0x7249, 0x5BFD, 0x5B6B, 0x2B6A, 0x12EB, 0x6F6A, 0x5AEB,
    0x388E, 0x2497, 0x7B6D, 0x2B6D, 0x5FED, 0x5AAD, 0x24AD, 0x72A7};
constexpr int character_width = 3, character_height = 5, advance = character_width + 1;

struct Tick {
    double part;  // of the greatest value
    std::string label;
};

// Rounded to three digits.
std::string label_of(double value) {
    if (value == 0) return "0";
    const double unit = std::pow(10, 2 - std::floor(std::log10(value)));
    return shortest(std::round(value * unit) / unit);
}

// Ticks at 0, in the middle and at the greatest value. For counts, the middle is rounded down.
std::vector<Tick> ticks_of(double most, bool are_counts) {
    std::vector<Tick> ticks{{0, "0"}};
    const auto add = [&](double value) {
        ticks.push_back({value / most, are_counts ? fixed(value, 0) : label_of(value)});
    };
    const double middle = are_counts ? std::floor(most / 2) : most / 2;
    if (middle > 0) add(middle);
    if (most > 0) add(most);
    return ticks;
}

class Scale {
public:
    Scale(const HeatMap& map, double most)
        : dot_(std::max(2, std::min(map.width / 400, map.height / 240))),
          ticks_(ticks_of(most, map.are_counts)),
          caption_(map.caption) {}

    [[nodiscard]] int height() const { return dot_ * (label_top + character_height + margin); }

    // Labels do not touch, as the middle tick is at least a third of the length from both ends.
    [[nodiscard]] int least_width() const {
        int widest = 0;
        for (const Tick& tick : ticks_) widest = std::max(widest, width_of(tick.label));
        return 2 * margin * dot_ + std::max(width_of(caption_), 3 * (widest + advance * dot_));
    }

    void draw(HeatPicture& picture, int top) const {
        const int left = margin * dot_, length = picture.width - 2 * left;
        write(picture, caption_, left, top + margin * dot_);
        for (int x = 0; x < length; ++x)
            fill(picture, left + x, top + bar_top * dot_, 1, bar_height * dot_,
                 heat_colour(x / (length - 1.0)));
        for (const auto& [part, label] : ticks_) {
            const int x = left + static_cast<int>(std::lround(part * (length - dot_)));
            fill(picture, x, top + (bar_top + bar_height) * dot_, dot_, dot_, ink);
            const int width = width_of(label);
            write(picture, label, std::clamp(x - (width - dot_) / 2, left, left + length - width),
                  top + label_top * dot_);
        }
    }

private:
    // In dots from the top of the scale.
    static constexpr int margin = 3, bar_top = margin + character_height + 2, bar_height = 4,
                         label_top = bar_top + bar_height + 3;

    [[nodiscard]] int width_of(std::string_view text) const {
        return dot_ * (advance * static_cast<int>(text.size()) - 1);
    }

    static void fill(HeatPicture& picture, int left, int top, int width, int height,
                     const Colour& colour) {
        for (int y = top; y < top + height; ++y)
            for (int x = left; x < left + width; ++x)
                std::ranges::copy(
                    colour, picture.bytes.begin() + 3 * (std::ptrdiff_t{y} * picture.width + x));
    }

    void write(HeatPicture& picture, std::string_view text, int x, int y) const {
        for (const char c : text) {
            const std::size_t at = drawn_characters.find(
                static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
            for (int i = 0; at != std::string_view::npos && i < character_width * character_height;
                 ++i)
                if (character_dots[at] >> i & 1)
                    fill(picture, x + i % character_width * dot_, y + i / character_width * dot_,
                         dot_, dot_, ink);
            x += advance * dot_;
        }
    }

    int dot_;  // its side in pixels
    std::vector<Tick> ticks_;
    std::string caption_;
};

std::vector<cl_float4> grey(std::span<const double> values) {
    std::vector<cl_float4> pixels;
    for (const double value : values) {
        const auto shade = static_cast<cl_float>(value);
        pixels.push_back({{shade, shade, shade, 1}});
    }
    return pixels;
}

}  // namespace

std::array<std::uint8_t, 3> heat_colour(double part) {
    const double place = std::clamp(part, 0.0, 1.0) * (heat_colours.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), heat_colours.size() - 2);
    Colour colour{};
    for (std::size_t channel = 0; channel < colour.size(); ++channel) {
        const int from = heat_colours[below][channel], to = heat_colours[below + 1][channel];
        colour[channel] = static_cast<std::uint8_t>(
            std::lround(from + (to - from) * (place - static_cast<double>(below))));
    }
    return colour;
}

HeatPicture heat_picture(const HeatMap& map) {
    const double most = std::ranges::max(map.values);
    const Scale scale(map, most);
    HeatPicture picture{{}, std::max(map.width, scale.least_width()), map.height + scale.height()};
    const auto pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    picture.bytes.assign(3 * pixels, background.front());
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        const auto width = static_cast<std::size_t>(map.width);
        const std::size_t pixel = i / width * static_cast<std::size_t>(picture.width) + i % width;
        std::ranges::copy(heat_colour(most > 0 ? map.values[i] / most : 0),
                          picture.bytes.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
    }
    scale.draw(picture, map.height);
    return picture;
}

void write_heat_map(const std::filesystem::path& path, const HeatMap& map) {
    if (has_floats(image_format(path))) {
        write_image(path, grey(map.values), map.width, map.height);
        return;
    }
    const HeatPicture picture = heat_picture(map);
    write_bytes_as_image(path, picture.bytes, picture.width, picture.height);
}

}  // namespace support
