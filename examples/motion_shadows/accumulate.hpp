// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "renderer.hpp"

namespace motion {

/// The reference: the mean of many pictures, each of one moment with an ordinary shadow map.
class Accumulation {
public:
    explicit Accumulation(Frame& frame);

    /// Draws `count` of the `moments` that divide the exposure, from moment `first` on. Moment 0
    /// clears the picture first.
    void draw(cl_uint first, cl_uint count, cl_uint moments);

    /// The mean of the first `moments`, as Renderer::picture().
    [[nodiscard]] std::vector<cl_float4> picture(cl_uint moments);

private:
    Frame& frame_;
    Sweep sweep_;
    cellist::Kernel add_moment_;
    cellist::Kernel finish_;
    cellist::Buffer<cl_ulong> seen_, lit_;
    cellist::Buffer<cl_float4> sums_, picture_;
};

}  // namespace motion
