// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "frame.hpp"
#include "image_difference.hpp"

namespace shadows {

/// The indirect light of a frame in double precision on the CPU: from the same surfaces and samples
/// as on the device, with B at full resolution and from all samples. Direct light is the device's.
struct Reference {
    std::vector<std::size_t> pixels;  ///< of the picture; all, or evenly spread ones
    std::vector<glm::dvec3> a, b, picture;
};

/// How a frame compares with its reference.
struct Accuracy {
    /// An error of a channel, in sRGB, that counts as a light leak or as an over-dark pixel.
    static constexpr double visible = 8.0 / 255;

    std::string visibility;            ///< what answered rays on the CPU
    std::uint64_t rays = 0;            ///< of B that were checked
    std::uint64_t rays_decided = 0;    ///< by the exact test, for the two answers differed
    std::uint64_t rays_different = 0;  ///< that the device answered wrongly
    std::uint64_t pixels = 0;          ///< compared
    bool all_pixels = false;           ///< SSIM is of whole pictures only
    support::ImageDifference picture;  ///< against B at full resolution and from all samples
    support::ImageDifference a;        ///< as a white surface shows it
    support::ImageDifference b;
    std::uint64_t leaks = 0;      ///< pixels that are brighter than the reference by `visible`
    std::uint64_t over_dark = 0;  ///< pixels that are darker by `visible`
};

/// The reference of the last frame.
[[nodiscard]] Reference make_reference(const Renderer& renderer);

/// Draws the frame once more and compares it.
[[nodiscard]] Accuracy compare_with_reference(Renderer& renderer, const Scene& scene);

}  // namespace shadows
