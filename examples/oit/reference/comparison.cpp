// SPDX-License-Identifier: MIT
#include "reference/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image_difference.hpp"

namespace oit {
namespace {

// Adds what the fragments' counts and depths tell.
void compare_depths(const Reference& reference, const StoredDepths& stored, Comparison& result) {
    result.has_depths = true;
    std::vector<double> depths;
    for (std::size_t p = 0; p < reference.image.size(); ++p) {
        const std::uint64_t begin = reference.offsets[p];
        depths.assign(stored.depths.begin() + static_cast<std::ptrdiff_t>(stored.offsets[p]),
                      stored.depths.begin() + static_cast<std::ptrdiff_t>(stored.offsets[p + 1]));
        if (depths.size() != reference.offsets[p + 1] - begin) {
            ++result.pixels_with_other_count;
            continue;
        }
        std::sort(depths.begin(), depths.end());
        for (std::size_t i = 0; i < depths.size(); ++i) {
            const double depth = reference.fragments[begin + i].depth;
            result.max_depth_error =
                std::max(result.max_depth_error, std::abs(depths[i] - depth) / depth);
        }
    }
}

}  // namespace

Comparison compare(const Reference& reference, std::span<const cl_float4> image,
                   const std::optional<StoredDepths>& depths) {
    Comparison result;
    result.pixels = reference.image.size();
    result.fragments = reference.fragments.size();
    result.pixels_nan = count_nan(image);
    const support::ImageDifference difference =
        support::difference(image, reference.image, reference.width, reference.height);
    result.psnr_db = difference.psnr_db;
    result.ssim = difference.ssim;
    result.max_abs_error = difference.max_abs_error;
    for (std::size_t p = 0; p < reference.image.size(); ++p) {
        if (reference.ambiguous[p]) ++result.pixels_ambiguous;
        if (difference.errors[p] > 1.0 / 255) {
            ++result.pixels_over;
            if (reference.ambiguous[p]) ++result.pixels_explained;
        }
    }
    if (depths && depths->offsets.size() == reference.offsets.size())
        compare_depths(reference, *depths, result);
    return result;
}

std::uint64_t count_nan(std::span<const cl_float4> image) {
    return static_cast<std::uint64_t>(std::ranges::count_if(image, [](const cl_float4& pixel) {
        return std::isnan(pixel.s[0]) || std::isnan(pixel.s[1]) || std::isnan(pixel.s[2]);
    }));
}

}  // namespace oit
