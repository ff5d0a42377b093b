#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <cellist/cellist.hpp>

#include "fragment.hpp"
#include "frame.hpp"
#include "raster/rasteriser.hpp"

namespace oit {

/// Milliseconds of the passes of a frame.
struct PassTimes {
    double transform_ms = 0;
    double raster_insert_ms = 0;  ///< binning, the opaque passes, shading and insertion
    double sort_blend_ms = 0;
    double frame_ms = 0;  ///< from clearing to the blended image on the device
};

/// Draws a frame on a device with per-pixel lists (Yang et al. 2010, section 4.1).
class Renderer {
public:
    /// Builds the kernels for what the frame needs and allocates. Refers to the device and the
    /// frame, which must outlive it. Throws cellist::Error where the device cannot hold the image.
    Renderer(const cellist::Device& device, const Frame& frame);

    /// Draws once, and blocks until the image is there.
    PassTimes draw();

    /// The linear image, row by row from the top.
    [[nodiscard]] std::vector<cl_float4> image() const { return image_.download(); }
    [[nodiscard]] const cellist::Lists<Fragment>& fragments() const { return fragments_; }
    /// Lists, image, mesh and everything else that the renderer holds on the device.
    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    // What only a frame with opaque surfaces has.
    struct Opaque {
        raster::DeviceMesh mesh;
        raster::Drawing drawing;
        raster::Pass depth_pass;
        raster::Pass colour_pass;
        cellist::Buffer<cl_uint> depth_bits;
        cellist::Buffer<cl_float4> colour;

        Opaque(const cellist::Device& device, raster::SetupKernels& setup, const Frame& frame);
    };

    void insert_fragments();
    void resolve();

    const cellist::Device& device_;
    const Frame& frame_;
    bool sorts_;
    raster::SetupKernels setup_;
    raster::DeviceMesh mesh_;
    raster::Drawing drawing_;
    cellist::Lists<Fragment> fragments_;
    raster::Pass transparent_pass_;
    cellist::Kernel resolve_;
    cellist::Buffer<cl_float4> image_;
    std::unique_ptr<Opaque> opaque_;
};

}  // namespace oit
