// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <cellist/cellist.hpp>

#include "frame/fragment_source.hpp"

namespace oit {

/// A frame through a lens, widened by a margin because surfaces beside the image blur into it. The
/// image is cut out of the widened picture.
class LensFrame {
public:
    /// The widest margin, as a part of the image's shorter side. Surfaces beyond it are not seen.
    static constexpr double margin_max = 0.25;

    /// Refers to the device and the frame, which must outlive it.
    LensFrame(const cellist::Device& device, const Frame& frame);

    /// The frame with the margin. Its fragments have the slopes of their depth.
    [[nodiscard]] const Frame& widened() const { return widened_; }

    /// Adopts the frame's views and time, which may have changed.
    void follow();
    /// Copies the image out of the picture of the widened frame. Does not block.
    void cut_out(const FragmentSource& source);

    /// The linear image, eye by eye, row by row from the top.
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const { return image_; }
    [[nodiscard]] std::uint64_t device_bytes() const { return raster::bytes_of(image_); }

private:
    const Frame& frame_;
    Frame widened_;
    cellist::Kernel cut_out_;
    cellist::Buffer<cl_float4> image_;
};

}  // namespace oit
