// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "budget/setting.hpp"
#include "budget/spread.hpp"
#include "reference/comparison.hpp"

namespace oit {

/// What a setting costs and gives on a device.
struct Measurement {
    Setting setting;
    std::string failure = {};        ///< why it could not be drawn; then there are no metrics
    std::vector<double> times = {};  ///< of frames, in milliseconds; see Renderer::draw
    double milliseconds = 0;         ///< of a frame, median
    double fastest = 0;              ///< the least
    double lower_quartile = 0, upper_quartile = 0;  ///< half of the times are between these
    std::uint64_t bytes = 0;                        ///< what the method keeps on the device
    Comparison comparison = {};                     ///< with the reference
    std::vector<cl_float4> image = {};              ///< linear, eye by eye

    [[nodiscard]] bool drawn() const { return failure.empty(); }

    /// Times of more frames.
    void add(const std::vector<double>& more);
    [[nodiscard]] Spread spread_ms() const {
        return {fastest, lower_quartile, milliseconds, upper_quartile};
    }
    /// How far from the median half of the times are at most, as a part of it.
    [[nodiscard]] double spread() const {
        return (upper_quartile - lower_quartile) / (2 * milliseconds);
    }
};

/// Draws a frame with a setting `frames` times after Renderer::warm_up(), or until ten seconds have
/// passed, and compares the image with the reference: that of all layers. Blocks. Does not throw
/// where the device cannot draw it.
[[nodiscard]] Measurement measure(const cellist::Device& device, const Frame& frame,
                                  const Setting& setting, const Reference& reference,
                                  std::uint32_t frames);

/// Draws a measured setting again and adds the times, unless its frames have taken ten seconds
/// already. Blocks. What the device can no longer draw becomes a failure.
void measure_again(const cellist::Device& device, const Frame& frame, std::uint32_t frames,
                   Measurement& measurement);

}  // namespace oit
