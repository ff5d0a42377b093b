#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <cellist/cellist.hpp>

#include "fragment_source.hpp"
#include "method.hpp"
#include "reduction.hpp"

namespace oit {

/// Milliseconds of the passes of a frame.
struct PassTimes {
    double transform_ms = 0;
    double raster_insert_ms = 0;  ///< binning, the opaque passes, shading and storing
    double sort_blend_ms = 0;
    double frame_ms = 0;  ///< from clearing to the blended image on the device
};

/// Draws a frame on a device with one of the methods.
class Renderer {
public:
    /// Builds the kernels for what the frame needs and allocates. Refers to the device and the
    /// frame, which must outlive it. Throws InputError where the method cannot draw the frame,
    /// cellist::Error where the device cannot hold it.
    Renderer(const cellist::Device& device, const Frame& frame,
             const MethodInfo& method = method_named("linked"));

    /// Draws once, and blocks until the image is there. Throws InputError where the method needs more than
    /// Frame::memory_bytes.
    PassTimes draw();
    /// The same at another time of the scene, in seconds.
    PassTimes draw_at(double time);

    /// The linear image, eye by eye, row by row from the top.
    [[nodiscard]] std::vector<cl_float4> image() const {
        return (reduction_ ? reduction_->image() : source_.image()).download();
    }
    [[nodiscard]] const Method& method() const { return *method_; }
    [[nodiscard]] const Needs& needs() const { return source_.needs(); }
    [[nodiscard]] const NodeLayout& layout() const { return source_.layout(); }
    /// Everything that the renderer holds on the device.
    [[nodiscard]] std::uint64_t device_bytes() const {
        return source_.device_bytes() + method_->device_bytes() +
               (reduction_ ? reduction_->device_bytes() : 0);
    }

private:
    const cellist::Device& device_;
    std::unique_ptr<Reduction> reduction_;  ///< where Quality::reduce asks for it
    FragmentSource source_;
    std::unique_ptr<Method> method_;
};

}  // namespace oit
