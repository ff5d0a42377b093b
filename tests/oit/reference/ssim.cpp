// SPDX-License-Identifier: MIT
// The structural similarity is that of Wang et al. 2004.
#include "ssim.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "support/catch.hpp"

namespace cellist::test {
namespace {

constexpr double c1 = 1e-4, c2 = 9e-4;  // (0.01)^2 and (0.03)^2

bool nearly(double a, double b) { return std::abs(a - b) < 1e-12; }

std::vector<double> noise(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(0, 1);
    std::vector<double> values(count);
    for (double& v : values) v = value(random);
    return values;
}

// What the paper defines, word for word: weighted means over the window around each pixel.
double defined_ssim(const std::vector<double>& a, const std::vector<double>& b, int width,
                    int height) {
    double sum = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto weighted = [&](const auto& value) {
                double values = 0, weights = 0;
                for (int v = std::max(0, y - 5); v <= std::min(height - 1, y + 5); ++v)
                    for (int u = std::max(0, x - 5); u <= std::min(width - 1, x + 5); ++u) {
                        const double weight =
                            std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * 1.5 * 1.5));
                        values += weight * value(static_cast<std::size_t>(v * width + u));
                        weights += weight;
                    }
                return values / weights;
            };
            const double mean_a = weighted([&](std::size_t p) { return a[p]; });
            const double mean_b = weighted([&](std::size_t p) { return b[p]; });
            const auto covariance = [&](const auto& first, double mean_first, const auto& second,
                                        double mean_second) {
                return weighted([&](std::size_t p) {
                    return (first[p] - mean_first) * (second[p] - mean_second);
                });
            };
            sum += (2 * mean_a * mean_b + c1) * (2 * covariance(a, mean_a, b, mean_b) + c2) /
                   ((mean_a * mean_a + mean_b * mean_b + c1) *
                    (covariance(a, mean_a, a, mean_a) + covariance(b, mean_b, b, mean_b) + c2));
        }
    return sum / (width * height);
}

TEST_CASE("an image is like itself") {
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 40}, {64, 48}}) {
        const auto image = noise(static_cast<std::size_t>(width * height), 7);
        CHECK(nearly(support::mean_ssim(image, image, static_cast<std::size_t>(width),
                                        static_cast<std::size_t>(height)),
                     1));
    }
}

TEST_CASE("of images of one value each, the luminance counts") {
    for (const double b : {0.0, 0.25, 1.0}) {
        const std::vector<double> first(40 * 30, 0.5), second(40 * 30, b);
        CHECK(nearly(support::mean_ssim(first, second, 40, 30), (b + c1) / (0.25 + b * b + c1)));
    }
}

TEST_CASE("an image and its negative are unlike") {
    std::vector<double> image(32 * 32), negative(32 * 32);
    for (std::size_t p = 0; p < image.size(); ++p) {
        image[p] = (p / 32 + p % 32) % 2 == 0 ? 1 : 0;
        negative[p] = 1 - image[p];
    }
    CHECK(support::mean_ssim(image, negative, 32, 32) < -0.98);
}

TEST_CASE("images of noise are as alike as the definition says") {
    for (const auto& [width, height] : {std::pair{23, 17}, {4, 9}, {1, 30}}) {
        const auto pixels = static_cast<std::size_t>(width * height);
        const std::vector<double> a = noise(pixels, 1);
        std::vector<double> b = noise(pixels, 2);
        for (std::size_t p = 0; p < pixels; ++p) b[p] = 0.7 * a[p] + 0.3 * b[p];
        const double ssim = support::mean_ssim(a, b, static_cast<std::size_t>(width),
                                               static_cast<std::size_t>(height));
        CHECK(nearly(ssim, defined_ssim(a, b, width, height)));
        CHECK(ssim < 0.99);
    }
}

}  // namespace
}  // namespace cellist::test
