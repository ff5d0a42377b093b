// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <cellist/cellist.hpp>

#include "budget/budget.hpp"
#include "budget/survey_result.hpp"
#include "frame/frame.hpp"

namespace oit {

/// A frame with all layers in float on the device, with bounds of its own error, against which
/// other pictures of the frame are measured.
///
/// Where two layers of a pixel differ in depth by less than float resolves (2^-20 of it), the
/// device may have them in an order that is not that of the numbers it was given. What their
/// exchange changes is found by blending both orders, and counted apart: PictureErrors::resolved
/// holds with the order that the device has, and PictureErrors::all with any.
class Survey {
public:
    /// Builds kernels. Measures cuts at these numbers of layers and parts of the light, at least
    /// one of each and no more than 16. Throws cellist::Error where the device cannot hold all
    /// fragments.
    Survey(const cellist::Device& device, const Frame& frame, std::vector<std::uint32_t> layers,
           std::vector<float> epsilons);
    Survey(const Survey&) = delete;
    Survey& operator=(const Survey&) = delete;
    ~Survey();

    /// Draws the frame, which differs from the first in time and views at most. Blocks.
    [[nodiscard]] SurveyResult measure(const Frame& frame);

    /// Compares another picture of the frame that was measured last, and counts the undecided
    /// pixels in which a channel may be off by more than `limit`. Blocks.
    [[nodiscard]] PictureErrors compare(const cellist::Buffer<cl_float4>& picture,
                                        double limit = 0);

private:
    class Drawing;
    template <class Node>
    class ListDrawing;
    std::unique_ptr<Drawing> drawing_;
};

}  // namespace oit
