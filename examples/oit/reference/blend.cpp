// SPDX-License-Identifier: MIT
#include "reference/blend.hpp"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

namespace oit {

using glm::dvec3;

namespace {

constexpr double no_distance = 0x1p-16;  // as a part of the depth: see blend.clh

}  // namespace

void ReferenceLight::pass_media(double depth) {
    if (depth_ <= 0) return;
    const double distance = depth - depth_;
    const dvec3 extinction = glm::max(extinction_, dvec3(0));
    transmittance_ *= glm::exp(-extinction * (distance * ray_length_));
    if (distance > no_distance * depth) extinction_ = extinction;
}

void ReferenceLight::add(const ReferenceFragment& fragment) {
    const double distance = depth_ > 0 ? (fragment.depth - depth_) * ray_length_ : 0;
    pass_media(fragment.depth);
    depth_ = fragment.depth;
    const double alpha = fragment.alpha;
    switch (fragment.blend) {
        case Blend::absorb: {
            constexpr double least = 1e-4;
            const dvec3 extinction = -glm::log(glm::max(fragment.colour, dvec3(least)));
            extinction_ += fragment.leaves ? -extinction : extinction;
            return;
        }
        case Blend::additive:
            colour_ += transmittance_ * alpha * fragment.colour;
            return;
        case Blend::multiplicative:
            transmittance_ *= glm::mix(dvec3(1), fragment.colour, alpha);
            return;
        case Blend::user:
            options_.get().blend(fragment, distance, colour_, transmittance_);
            return;
        default:
            colour_ += transmittance_ * alpha * fragment.colour;
            transmittance_ *= 1 - alpha;
    }
}

dvec3 ReferenceLight::end(const dvec3& behind, double depth) {
    if (depth < std::numeric_limits<double>::infinity()) pass_media(depth);
    return colour_ + transmittance_ * behind;
}

}  // namespace oit
