#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "comparison.hpp"
#include "setting.hpp"

namespace oit {

/// What a setting costs and gives on a device.
struct Measurement {
    Setting setting;
    std::string failure = {};           ///< why it could not be drawn; then there are no figures
    double milliseconds = 0;            ///< of a frame, median; see Renderer::draw
    double fastest = 0;                 ///< the least
    std::uint32_t runs = 0;             ///< frames that were timed
    std::uint64_t bytes = 0;            ///< what the method keeps on the device
    Comparison comparison = {};         ///< with the reference
    std::vector<cl_float4> image = {};  ///< linear, eye by eye

    [[nodiscard]] bool drawn() const { return failure.empty(); }
};

/// Draws a frame with a setting `runs` times after Renderer::warm_up(), or until ten seconds have
/// passed, and compares the image with the reference: that of all layers. Blocks. Does not throw
/// where the device cannot draw it.
[[nodiscard]] Measurement measure(const cellist::Device& device, const Frame& frame,
                                  const Setting& setting, const Reference& reference,
                                  std::uint32_t runs);

}  // namespace oit
