// SPDX-License-Identifier: MIT
// Flat parts of 8-bit pictures are dithered: backgrounds have no bands, and means are right.
#include <cmath>
#include <cstdlib>
#include <vector>

#include "image.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

TEST_CASE("a byte is off by less than 1, and the mean of many is right") {
    constexpr int side = 200;
    for (const float linear : {0.0F, 0.0123F, 0.0126F, 0.2F, 0.7F, 1.0F}) {
        const std::vector<cl_float4> pixels(side * side, {{linear, linear, linear, 1}});
        const std::vector<std::uint8_t> bytes = support::srgb_bytes(pixels, side);
        const double exact = 255 * support::srgb_from_linear(static_cast<double>(linear));
        double sum = 0;
        for (const std::uint8_t byte : bytes) {
            REQUIRE(std::abs(byte - exact) < 1);
            sum += byte;
        }
        CHECK(std::abs(sum / static_cast<double>(bytes.size()) - exact) < 0.01);
        CHECK(bytes == support::srgb_bytes(pixels, side));
    }
}

TEST_CASE("pixels that differ from their neighbours are rounded") {
    std::vector<cl_float4> pixels;
    for (int i = 0; i < 1000; ++i) {
        const float linear = static_cast<float>(i % 500) / 500;
        pixels.push_back({{linear, 0.3F, 1 - linear, 1}});
    }
    const std::vector<std::uint8_t> bytes = support::srgb_bytes(pixels, 1000);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto linear = static_cast<double>(pixels[i / 3].s[i % 3]);
        CHECK(bytes[i] == std::lround(255 * support::srgb_from_linear(linear)));
    }
}

TEST_CASE("the first pixel of a row is no neighbour of the last one before it") {
    // Columns of 2 colours: no pixel equals the next one of its row.
    std::vector<cl_float4> pixels;
    for (int i = 0; i < 3 * 500; ++i) {
        const float linear = i % 3 == 1 ? 0.2F : 0.3F;
        pixels.push_back({{linear, linear, linear, 1}});
    }
    const std::vector<std::uint8_t> bytes = support::srgb_bytes(pixels, 3);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const auto linear = static_cast<double>(pixels[i / 3].s[0]);
        REQUIRE(bytes[i] == std::lround(255 * support::srgb_from_linear(linear)));
    }
}

TEST_CASE("values beyond the range, and NaN, are bytes of the range") {
    const float none = std::nanf("");
    const std::vector<cl_float4> pixels(100, {{-1, 2, none, 1}});
    const std::vector<std::uint8_t> bytes = support::srgb_bytes(pixels, 10);
    for (std::size_t i = 0; i < bytes.size(); ++i) CHECK(bytes[i] == (i % 3 == 1 ? 255 : 0));
}

}  // namespace
}  // namespace cellist::test
