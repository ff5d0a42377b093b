#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image.hpp"

namespace oit {

Comparison compare(const Reference& reference, std::span<const cl_float4> image,
                   const cellist::HostLists<Fragment>& fragments) {
    Comparison result;
    result.pixels = reference.image.size();
    result.fragments = reference.fragments.size();
    double squares = 0;
    std::vector<double> depths;
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

        const std::uint64_t begin = reference.offsets[p];
        const std::uint64_t length = reference.offsets[p + 1] - begin;
        const auto list = fragments.cell(p);
        if (list.size() != length) {
            ++result.pixels_with_other_count;
            continue;
        }
        depths.clear();
        for (const Fragment& fragment : list) depths.push_back(static_cast<double>(fragment.depth));
        std::sort(depths.begin(), depths.end());
        for (std::size_t i = 0; i < depths.size(); ++i) {
            const double depth = reference.fragments[begin + i].depth;
            result.max_depth_error =
                std::max(result.max_depth_error, std::abs(depths[i] - depth) / depth);
        }
    }
    const double mean =
        squares / (3.0 * static_cast<double>(std::max<std::uint64_t>(1, result.pixels)));
    result.psnr_db = -10 * std::log10(mean);
    return result;
}

}  // namespace oit
