// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "frame.hpp"
#include "pass_times.hpp"

namespace motion {

/// The contents and the memory of a shadow map.
struct ShadowMapSize {
    std::uint64_t fragments = 0;  ///< of prisms
    std::uint64_t ranges = 0;     ///< before compression
    std::uint64_t unpaired = 0;   ///< fragments that make no range
    std::uint64_t pieces = 0;     ///< ranges after compression
    std::uint64_t bytes = 0;      ///< of device memory
    std::uint64_t slices = 0;     ///< of the last frame; 0 where it was built whole
    std::uint64_t refused = 0;    ///< triangles that are not finite
};

/// A way to compute shadows.
class ShadowMethod {
public:
    ShadowMethod() = default;
    ShadowMethod(const ShadowMethod&) = delete;
    ShadowMethod& operator=(const ShadowMethod&) = delete;
    virtual ~ShadowMethod() = default;

    /// Marks the receivers of a batch of samples that are in shadow. Makes the shadow map with the
    /// first batch of a frame.
    virtual void mark_shadows(Frame& frame, const Sampling& batch, support::PassTimes* times) = 0;

    /// Of the last frame. Blocks.
    [[nodiscard]] virtual ShadowMapSize size() const = 0;
};

[[nodiscard]] std::unique_ptr<ShadowMethod> make_exact(const Frame& frame);
/// The method of the paper.
[[nodiscard]] std::unique_ptr<ShadowMethod> make_ranges(const Frame& frame);
[[nodiscard]] std::unique_ptr<ShadowMethod> make_tsm(const Frame& frame);
[[nodiscard]] std::unique_ptr<ShadowMethod> make_still(const Frame& frame);

}  // namespace motion
