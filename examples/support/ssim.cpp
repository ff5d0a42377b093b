// SPDX-License-Identifier: MIT
#include "ssim.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace support {
namespace {

constexpr std::ptrdiff_t reach = 5;  // of the window, to each side
constexpr double deviation = 1.5;
constexpr double c1 = 0.01 * 0.01;  // (K1 L)^2 and (K2 L)^2 of the paper, for values up to L = 1
constexpr double c2 = 0.03 * 0.03;

std::array<double, 2 * reach + 1> window() {
    std::array<double, 2 * reach + 1> weights{};
    for (std::ptrdiff_t i = -reach; i <= reach; ++i)
        weights[static_cast<std::size_t>(i + reach)] =
            std::exp(-static_cast<double>(i * i) / (2 * deviation * deviation));
    return weights;
}

// The weighted mean around each of `count` values that are `stride` apart, in place.
void blur_line(double* values, std::size_t count, std::size_t stride) {
    static const auto weights = window();
    std::vector<double> line(count);
    for (std::size_t i = 0; i < count; ++i) line[i] = values[i * stride];
    const auto last = static_cast<std::ptrdiff_t>(count) - 1;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        double sum = 0, weight_sum = 0;
        for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach);
             j <= std::min(last, i + reach); ++j) {
            const double weight = weights[static_cast<std::size_t>(j - i + reach)];
            sum += weight * line[static_cast<std::size_t>(j)];
            weight_sum += weight;
        }
        values[static_cast<std::size_t>(i) * stride] = sum / weight_sum;
    }
}

// The mean around each pixel of what `value` says of it.
std::vector<double> means(std::size_t width, std::size_t height, const auto& value) {
    std::vector<double> result(width * height);
    for (std::size_t p = 0; p < result.size(); ++p) result[p] = value(p);
    for (std::size_t y = 0; y < height; ++y) blur_line(&result[y * width], width, 1);
    for (std::size_t x = 0; x < width; ++x) blur_line(&result[x], height, width);
    return result;
}

}  // namespace

double mean_ssim(std::span<const double> a, std::span<const double> b, std::size_t width,
                 std::size_t height) {
    const auto mean_of = [&](const auto& value) { return means(width, height, value); };
    const std::vector<double> mean_a = mean_of([&](std::size_t p) { return a[p]; });
    const std::vector<double> mean_b = mean_of([&](std::size_t p) { return b[p]; });
    const std::vector<double> mean_aa = mean_of([&](std::size_t p) { return a[p] * a[p]; });
    const std::vector<double> mean_bb = mean_of([&](std::size_t p) { return b[p] * b[p]; });
    const std::vector<double> mean_ab = mean_of([&](std::size_t p) { return a[p] * b[p]; });
    double sum = 0;
    for (std::size_t p = 0; p < width * height; ++p) {
        const double variance_a = mean_aa[p] - mean_a[p] * mean_a[p];
        const double variance_b = mean_bb[p] - mean_b[p] * mean_b[p];
        const double covariance = mean_ab[p] - mean_a[p] * mean_b[p];
        sum +=
            (2 * mean_a[p] * mean_b[p] + c1) * (2 * covariance + c2) /
            ((mean_a[p] * mean_a[p] + mean_b[p] * mean_b[p] + c1) * (variance_a + variance_b + c2));
    }
    return sum / static_cast<double>(width * height);
}

}  // namespace support
