#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "frame.hpp"

namespace oit {

/// Two depths are told apart by the device if they differ by more than this part of the greater
/// one. The device's depth is off by a factor of at most 1 +- 8 * 2^-24 (see scan.clh); two of them
/// by twice that.
inline constexpr double depth_resolution = 16.0 / (1 << 24);

struct ReferenceFragment {
    double depth;
    glm::dvec3 colour;
};

/// A frame in double precision.
struct Reference {
    std::vector<glm::dvec3> image;             ///< linear
    std::vector<std::uint64_t> offsets;        ///< pixels + 1 offsets into `fragments`
    std::vector<ReferenceFragment> fragments;  ///< by pixel, nearest first
    /// Pixels where float cannot tell the order of two fragments that count, or whether a fragment
    /// is behind the opaque surface.
    std::vector<bool> ambiguous;
};

/// Draws a frame on the CPU: snapped geometry as on the device, everything else in double
/// precision, exactly sorted. One thread. `progress` is called with the finished part, from 0 to 1.
[[nodiscard]] Reference draw_reference(const Frame& frame,
                                       const std::function<void(double)>& progress = {});

}  // namespace oit
