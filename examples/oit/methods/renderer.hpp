// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <cellist/cellist.hpp>

#include "frame/fragment_source.hpp"
#include "frame/lens_frame.hpp"
#include "frame/reduction.hpp"
#include "methods/count_fragments.hpp"
#include "methods/method.hpp"
#include "methods/pixel_list.hpp"

namespace oit {

/// Milliseconds of the passes of a frame, each alone on the device.
struct PassTimes {
    double transform_ms = 0;
    double raster_insert_ms = 0;  ///< binning, the opaque passes, shading and storing
    double sort_blend_ms = 0;
};

/// What to call after each pass of a frame is enqueued, with the place for its time.
using AfterPass = std::function<void(double PassTimes::*)>;

/// Draws a frame on a device with one of the methods.
class Renderer {
public:
    /// Builds the kernels for what the frame needs and allocates. Refers to the device and the
    /// frame, which must outlive it. Throws InputError where the method cannot draw the frame,
    /// cellist::Error where the device cannot hold it.
    Renderer(const cellist::Device& device, const Frame& frame,
             const MethodInfo& method = method_named("linked"));

    /// Draws until frames are of one kind: builds the kernels' last variants and grows pools.
    /// Blocks.
    void warm_up();
    /// Draws once, and blocks until the image is there: milliseconds from clearing to the image.
    /// Throws InputError where the method needs more than Frame::memory_bytes.
    double draw();
    /// The halves of draw(): the first enqueues the frame, and blocks only where frames are not of
    /// one kind yet; the second blocks until the image is there. In between, another renderer can
    /// start the next frame, so that the device does not wait for the host.
    void start(const AfterPass& after_pass = [](double PassTimes::*) {});
    void finish();
    /// The same as draw() where the frame has another time, or other views of the same size.
    double draw_changed();
    /// The same as draw() with a wait after each pass, so that a frame takes longer.
    PassTimes draw_by_pass();

    /// The linear image, eye by eye, row by row from the top.
    [[nodiscard]] std::vector<cl_float4> image() const { return picture().download(); }
    /// The same on the device.
    [[nodiscard]] const cellist::Buffer<cl_float4>& picture() const {
        if (lens_) return lens_->image();
        return reduction_ ? reduction_->image() : source_.image();
    }
    /// The number of transparent fragments in each pixel of drawn_frame(), whatever the method
    /// stores. Draws them once more. Blocks.
    [[nodiscard]] std::vector<cl_uint> layers() { return count_fragments(source_); }
    /// The transparent fragments of a pixel of the image of an eye, nearest first; without those of
    /// other pixels. With Quality::reduce, of the larger pixel around it. Blocks.
    [[nodiscard]] std::vector<PixelFragment> fragments_at(int x, int y, std::size_t eye);
    /// The frame whose fragments the method gets: smaller than the image with Quality::reduce.
    [[nodiscard]] const Frame& drawn_frame() const { return source_.frame(); }
    [[nodiscard]] const Method& method() const { return *method_; }
    [[nodiscard]] const FrameFeatures& features() const { return source_.features(); }
    [[nodiscard]] const NodeLayout& layout() const { return source_.layout(); }
    /// Everything that the renderer holds on the device.
    [[nodiscard]] std::uint64_t device_bytes() const {
        return source_.device_bytes() + method_->device_bytes() +
               (lens_ ? lens_->device_bytes() : 0) + (reduction_ ? reduction_->device_bytes() : 0);
    }

private:
    // Waits for the frame. False if something had no room: it has grown, and the frame must start
    // again.
    [[nodiscard]] bool finish_or_grow();

    const cellist::Device& device_;
    // The frame that is drawn, if it is not the whole one.
    [[nodiscard]] const Frame& drawn(const Frame& frame) const;

    std::unique_ptr<LensFrame> lens_;       ///< where Frame::lens asks for it
    std::unique_ptr<Reduction> reduction_;  ///< where Quality::reduce asks for it
    FragmentSource source_;
    std::unique_ptr<Method> method_;
};

}  // namespace oit
