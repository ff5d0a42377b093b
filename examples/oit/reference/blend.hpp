// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <glm/vec3.hpp>

#include "reference/reference.hpp"

namespace oit {

/// Blends fragments front to back: blend.clh in double precision.
class ReferenceLight {
public:
    /// `ray_length` is the distance for a depth of 1. Refers to the options.
    ReferenceLight(double ray_length, const ReferenceOptions& options)
        : ray_length_(ray_length), options_(options) {}

    /// One more fragment, behind all so far.
    void add(const ReferenceFragment& fragment);
    /// The colour with what is behind, at a depth that may be infinite.
    [[nodiscard]] glm::dvec3 end(const glm::dvec3& behind, double depth);

private:
    void pass_media(double depth);

    double ray_length_;
    std::reference_wrapper<const ReferenceOptions> options_;
    glm::dvec3 colour_{0.0};
    glm::dvec3 transmittance_{1.0};
    glm::dvec3 extinction_{0.0};
    double depth_ = 0;
};

}  // namespace oit
