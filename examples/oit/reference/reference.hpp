// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "frame/frame.hpp"

namespace oit {

struct ReferenceFragment {
    double depth;
    glm::dvec3 colour;
    double alpha;
    Blend blend;
    bool leaves;  ///< of Blend::absorb: the medium ends here
    std::uint32_t coverage;
    std::array<double, 8> sample_depth;  ///< of the covered samples
};

/// A frame in double precision.
struct Reference {
    std::size_t width = 0, height = 0;         ///< of an eye's image
    std::vector<glm::dvec3> image;             ///< linear, eye by eye
    std::vector<std::uint64_t> offsets;        ///< pixels + 1 offsets into `fragments`
    std::vector<ReferenceFragment> fragments;  ///< by pixel, nearest first
    /// Pixels where the nodes' format cannot tell the order of two fragments that count, or float
    /// whether a fragment is behind the opaque surface.
    std::vector<bool> ambiguous;

    /// The number of fragments in each pixel.
    [[nodiscard]] std::vector<std::uint32_t> layers() const;
    /// Fragments of the pixel that has the most.
    [[nodiscard]] std::uint64_t most_layers() const;
};

struct ReferenceOptions {
    /// Called with the finished part, from 0 to 1.
    std::function<void(double)> progress = {};
    /// What the user's blend function computes, in double precision.
    std::function<void(const ReferenceFragment& fragment, double distance, glm::dvec3& colour,
                       glm::dvec3& transmittance)>
        blend = {};
};

/// How much a pixel changes, at most, if two surfaces of Blend::over that follow one another change
/// places: the product of their opacities and the difference of their colours.
[[nodiscard]] double swap_error(const ReferenceFragment& a, const ReferenceFragment& b);

/// Draws a frame on the CPU, with code of its own from the projection on. Vertices snap to
/// sub-pixels by the same definition as on the device (see Projection); everything else is in
/// double precision and exactly sorted: by the depths at the mean of the covered samples, as nodes
/// have them, or with Quality::depth_range in each sample by the depths there. Blends all fragments
/// of Quality::layers, whatever epsilon and node format are. Throws InputError where a user's
/// function blends on the device and none is given here. One thread.
[[nodiscard]] Reference draw_reference(const Frame& frame, const ReferenceOptions& options = {});

}  // namespace oit
