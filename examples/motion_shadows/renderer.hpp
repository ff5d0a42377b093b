// SPDX-License-Identifier: MIT
#pragma once

#include "frame.hpp"
#include "method.hpp"
#include "pass_times.hpp"

namespace motion {

/// Draws a scene with motion blur: several samples of each pixel, each at its own time.
class Renderer {
public:
    Renderer(const cellist::Device& device, const Scene& scene, const Settings& settings);

    /// Draws with the method's shadows. Blocks while lists are built.
    void draw(ShadowMethod& method, support::PassTimes* times = nullptr);

    [[nodiscard]] Frame& frame() { return frame_; }
    /// Linear RGB, and the part of the samples that are in shadow; row by row from the top.
    [[nodiscard]] const cellist::Buffer<cl_float4>& picture() const { return picture_; }

private:
    [[nodiscard]] Sampling batch(cl_uint first) const;
    void find_visible(const Sampling& batch);

    Frame frame_;
    Sweep sweep_;
    cellist::Kernel make_receivers_;
    cellist::Kernel add_samples_;
    cellist::Kernel finish_;
    cellist::Buffer<cl_float4> sums_;
    cellist::Buffer<cl_float4> picture_;
};

}  // namespace motion
