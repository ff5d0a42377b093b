#include "reference/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "image.hpp"
#include "reference/ssim.hpp"

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

// What is seen of both pictures where their structure is compared: luma of Rec. 709.
class Luma {
public:
    explicit Luma(const Reference& reference)
        : width_(reference.width),
          height_(reference.height),
          is_(reference.image.size()),
          should_(reference.image.size()) {}

    void add(std::size_t pixel, int channel, double is, double should) {
        constexpr std::array weights{0.2126, 0.7152, 0.0722};
        is_[pixel] += weights[static_cast<std::size_t>(channel)] * is;
        should_[pixel] += weights[static_cast<std::size_t>(channel)] * should;
    }

    // The mean of all eyes.
    [[nodiscard]] double ssim() const {
        const std::size_t pixels = width_ * height_;
        double sum = 0;
        for (std::size_t first = 0; first < is_.size(); first += pixels)
            sum += mean_ssim(std::span(is_).subspan(first, pixels),
                             std::span(should_).subspan(first, pixels), width_, height_);
        return sum * static_cast<double>(pixels) / static_cast<double>(is_.size());
    }

private:
    std::size_t width_, height_;
    std::vector<double> is_, should_;
};

}  // namespace

Comparison compare(const Reference& reference, std::span<const cl_float4> image,
                   const std::optional<StoredDepths>& depths) {
    Comparison result;
    result.pixels = reference.image.size();
    result.fragments = reference.fragments.size();
    result.pixels_nan = count_nan(image);
    Luma luma(reference);
    double squares = 0;
    for (std::size_t p = 0; p < reference.image.size(); ++p) {
        double error = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const double is = support::srgb_from_linear(static_cast<double>(image[p].s[channel]));
            const double should = support::srgb_from_linear(reference.image[p][channel]);
            const double difference = std::abs(is - should);
            squares += difference * difference;
            error = std::max(error, difference);
            luma.add(p, channel, is, should);
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
    result.ssim = luma.ssim();
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
