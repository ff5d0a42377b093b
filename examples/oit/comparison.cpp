#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image.hpp"

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
    double squares = 0;
    for (std::size_t p = 0; p < reference.image.size(); ++p) {
        double error = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const double is = support::srgb_from_linear(static_cast<double>(image[p].s[channel]));
            const double difference =
                std::abs(is - support::srgb_from_linear(reference.image[p][channel]));
            squares += difference * difference;
            error = std::max(error, difference);
        }
        result.max_abs_error = std::max(result.max_abs_error, error);
        if (reference.ambiguous[p]) ++result.pixels_ambiguous;
        if (error > 1.0 / 255) {
            ++result.pixels_over;
            if (reference.ambiguous[p]) ++result.pixels_explained;
        }
    }
    const double mean =
        squares / (3.0 * static_cast<double>(std::max<std::uint64_t>(1, result.pixels)));
    result.psnr_db = -10 * std::log10(mean);
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
