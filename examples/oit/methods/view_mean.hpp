// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "methods/renderer.hpp"
#include "reference/reference.hpp"

namespace oit {

/// The mean of pinhole pictures from many views: the effect of a lens, or of many samples a pixel.
class ViewMean {
public:
    /// The views of the i-th picture, one for each eye.
    using Views = std::function<std::vector<raster::View>(std::size_t i)>;

    /// Draws the scene of `frame` with the method `linked`, all layers, and one sample a pixel.
    /// Refers to the device and the frame's scene, which must outlive it.
    ViewMean(const cellist::Device& device, const Frame& frame);

    /// Draws `count` pictures at `time`, and averages them. Blocks until the last is enqueued.
    /// `progress` gets the finished part, from 0 to 1.
    void draw(
        double time, std::size_t count, const Views& views,
        const std::function<void(double)>& progress = [](double) {});

    /// The linear mean, eye by eye, row by row from the top.
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const { return image_; }
    /// The mean as a reference, which has no fragments. Blocks.
    [[nodiscard]] Reference reference() const;
    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    Frame frame_;
    Renderer renderer_;
    cellist::Kernel add_;
    cellist::Buffer<cl_float4> image_;
};

/// `count` views of each eye through places spread evenly over the frame's lens. Refers to the
/// frame.
[[nodiscard]] ViewMean::Views views_through_lens(const Frame& frame, std::size_t count);

/// The number of pictures whose mean is the reference of a frame; 0 if it is drawn in double
/// precision.
[[nodiscard]] std::size_t reference_views(const Frame& frame);

/// The reference of a frame: draw_reference(), or for Frame::lens and Coverage::exact the mean of
/// reference_views() pictures by the method `linked`. A mean has no fragments. Blocks.
[[nodiscard]] Reference reference_of(const cellist::Device& device, const Frame& frame,
                                     const std::function<void(double)>& progress);

}  // namespace oit
