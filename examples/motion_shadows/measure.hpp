// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "image_difference.hpp"
#include "options.hpp"
#include "renderer.hpp"
#include "self_shadow.hpp"

namespace motion {

/// A method as the command line names it.
struct NamedMethod {
    std::string_view name;
    /// Null for the reference, which is no shadow map.
    std::unique_ptr<ShadowMethod> (*make)(const Frame&);
};

constexpr std::string_view reference_name = "accumulate";

constexpr std::array<NamedMethod, 5> methods{{{"exact", make_exact},
                                              {"ranges", make_ranges},
                                              {"tsm", make_tsm},
                                              {"static", make_still},
                                              {reference_name, nullptr}}};

/// How far a picture is from the reference.
struct Comparison {
    support::ImageDifference picture;
    SelfShadowing self_shadowing;
};

/// The results of a method in a scene.
struct Measurement {
    std::string_view method;
    cl_uint samples = 0;  ///< of each pixel; of the reference, its moments
    std::vector<double> frames_ms = {};
    std::vector<std::pair<std::string, double>> passes_ms =
        {};  ///< medians, with waits between passes
    ShadowMapSize size = {};
    cellist::Storage storage = {};        ///< of lists
    std::vector<cl_float4> picture = {};  ///< as Renderer::picture()
    std::optional<Comparison> comparison = {};
};

/// What the paper's Equation 2 counts: in the whole shadow map, with the insides of surfaces.
struct PaperSize {
    std::uint64_t ranges = 0;     ///< of the method exact
    std::uint64_t fragments = 0;  ///< of the method ranges if it is drawn, else two for each range

    /// Equation 2: 16 bytes a fragment, 24 a range, and two indices a texel.
    [[nodiscard]] std::uint64_t bytes(std::uint64_t texels) const {
        return 16 * fragments + 24 * ranges + 2 * 4 * texels;
    }
};

/// Draws the pictures that the options ask for, and shows its progress.
[[nodiscard]] std::vector<Measurement> measure(const cellist::Device& device, const Scene& scene,
                                               const Options& options);

/// Builds the whole shadow map.
[[nodiscard]] PaperSize paper_size(const cellist::Device& device, const Scene& scene,
                                   const Options& options);

}  // namespace motion
