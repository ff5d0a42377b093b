#include "heat_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "image.hpp"
#include "number_text.hpp"

namespace shadows {
namespace {

// A part from 0 to 1 as a colour in sRGB.
std::array<std::uint8_t, 3> heat_colour(double part) {
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t channel = 0; channel < 3; ++channel)
        colour[channel] = static_cast<std::uint8_t>(
            std::lround(255 * std::clamp(3 * part - static_cast<double>(channel), 0.0, 1.0)));
    return colour;
}

// The characters of numbers, 3 x 5 pixels each, row by row from the lowest bit.
constexpr std::string_view drawn_characters = "0123456789.";
constexpr std::array<unsigned, 11> character_bits{0x7B6F, 0x749A, 0x73E7, 0x79E7, 0x49ED, 0x79CF,
                                                  0x7BCF, 0x4927, 0x7BEF, 0x79EF, 0x2000};

class HeatScale {
public:
    HeatScale(std::vector<std::uint8_t>& bytes, int width, int height)
        : bytes_(bytes), width_(width), height_(height) {}

    void draw(double most) {
        constexpr int bar = 128, margin = 6, bar_height = 8;
        const int top = height_ - 32;
        for (int x = -margin; x < bar + 40; ++x)
            for (int y = -margin; y < 26; ++y) set(margin + x, top + y, {40, 40, 40});
        for (int x = 0; x < bar; ++x)
            for (int y = 0; y < bar_height; ++y)
                set(margin + x, top + y, heat_colour(x / (bar - 1.0)));
        for (const double part : {0.0, 0.5, 1.0})
            write(support::shortest(std::round(1e3 * part * most) / 1e3),
                  margin + static_cast<int>(part * bar), top + bar_height + 4);
    }

private:
    static constexpr int enlarge = 2;

    void set(int x, int y, const std::array<std::uint8_t, 3>& colour) {
        if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
        std::copy(colour.begin(), colour.end(),
                  bytes_.begin() + 3 * (std::ptrdiff_t{y} * width_ + x));
    }
    void write(const std::string& text, int x, int y) {
        for (const char c : text) {
            const std::size_t at = drawn_characters.find(c);
            if (at == std::string_view::npos) continue;
            for (int i = 0; i < 15 * enlarge * enlarge; ++i) {
                const int column = i % (3 * enlarge), row = i / (3 * enlarge);
                if (character_bits[at] >> (row / enlarge * 3 + column / enlarge) & 1)
                    set(x + column, y + row, {255, 255, 255});
            }
            x += 4 * enlarge;
        }
    }

    std::vector<std::uint8_t>& bytes_;
    int width_, height_;
};

}  // namespace

void write_heat_map(const std::filesystem::path& path, std::span<const double> values, double most,
                    int width, int height) {
    if (support::has_floats(support::image_format(path))) {
        std::vector<cl_float4> pixels;
        for (const double value : values) {
            const auto grey = static_cast<cl_float>(value);
            pixels.push_back({{grey, grey, grey, 1}});
        }
        support::write_image(path, pixels, width, height);
        return;
    }
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * values.size());
    for (const double value : values)
        for (const std::uint8_t channel : heat_colour(most > 0 ? value / most : 0))
            bytes.push_back(channel);
    HeatScale(bytes, width, height).draw(most);
    support::write_bytes_as_image(path, bytes, width, height);
}

}  // namespace shadows
