// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "budget/budget.hpp"
#include "frame/node_format.hpp"

namespace oit {

/// What a survey found out about a frame. Errors are upper bounds against the truth; where they do
/// not say otherwise, apart from what depends on an order of layers that float depths do not
/// resolve.
struct SurveyResult {
    /// Blending ends behind the nearest layers, or where little light passes.
    struct Cut {
        std::uint32_t layers = 0;  ///< as Quality::layers; 0 where the end is by epsilon
        float epsilon = 0;
        PictureError error;       ///< with float nodes
        double light_behind = 0;  ///< of Cut::layers: what passes to the layers left out, at most
    };

    std::uint64_t pixels = 0;
    std::uint64_t fragments = 0;
    std::uint64_t nonempty_pixels = 0;
    std::uint64_t longest = 0;  ///< most layers in a pixel
    /// Pixels by layers: none, 1, 2 to 3, 4 to 7 and so on.
    std::vector<std::uint64_t> pixels_by_layers;
    float least_alpha = 1;
    float greatest_alpha = 0;
    /// Pixels where depths as float, with 24 and with 16 bits do not resolve an order that matters.
    std::array<std::uint64_t, 3> pixels_unresolved{};

    PictureError exact;             ///< of all layers in float
    PictureError exact_with_order;  ///< the same, whatever the unresolved order
    /// Of all layers in each format; 1 where nothing better is known.
    std::array<PictureError, node_formats.size()> formats;
    std::vector<Cut> cuts;

    [[nodiscard]] const PictureError& format(NodeFormat format) const {
        return formats.at(static_cast<std::size_t>(format));
    }
    /// Nothing where that was not asked for.
    [[nodiscard]] const Cut* layers_cut(std::uint32_t layers) const {
        const auto at = std::find_if(cuts.begin(), cuts.end(),
                                     [&](const Cut& cut) { return cut.layers == layers; });
        return at == cuts.end() ? nullptr : &*at;
    }
    [[nodiscard]] const Cut* epsilon_cut(float epsilon) const {
        const auto at = std::find_if(cuts.begin(), cuts.end(), [&](const Cut& cut) {
            return cut.layers == 0 && cut.epsilon == epsilon;
        });
        return at == cuts.end() ? nullptr : &*at;
    }
};

}  // namespace oit
