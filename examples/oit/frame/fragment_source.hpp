// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/cellist.hpp>

#include "frame/frame.hpp"
#include "frame/frame_features.hpp"
#include "frame/node_layout.hpp"
#include "frame/oit_frame.hpp"
#include "raster/rasteriser.hpp"

namespace oit {

/// What depths as bits of floats begin with, where atomic minima find the least.
inline constexpr cl_uint infinity_bits =
    std::bit_cast<cl_uint>(std::numeric_limits<cl_float>::infinity());

/// What all methods have in common: projects a frame's scene, draws its opaque surfaces, and hands
/// the transparent fragments in front of them to a method's pass; then kernels over the pixels make
/// the image.
class FragmentSource {
public:
    /// Refers to the device and the frame, which must outlive it. Throws InputError where the
    /// user's blend function does not compile, cellist::Error where the device cannot hold the
    /// image.
    FragmentSource(const cellist::Device& device, const Frame& frame);

    /// The frame has another time, or other views of the same size. Blocks.
    void follow();

    /// The instances of the scene in the image: transform() comes before all else in a frame.
    [[nodiscard]] raster::Projection& projection() { return projection_; }

    /// Divides large triangles into blocks and draws the opaque surfaces. Does not block. With
    /// Quality::reduce, the opaque depths are the caller's to write.
    void prepare() {
        transparent_.bin();
        if (opaque_ && opaque_->passes) draw_opaque();
    }

    /// For a note that kernels leave: see raster::Triangles::note().
    [[nodiscard]] const cellist::Buffer<raster::RasterCounts>& counts() const {
        return transparent_.counts();
    }
    [[nodiscard]] cl_uint note() const { return transparent_.note(); }

    /// Starts the reads that finish_or_grow() waits for: best when a frame is enqueued.
    void read_counts() {
        transparent_.read_counts();
        if (opaque_ && opaque_->passes) opaque_->passes->triangles.read_counts();
    }

    /// Waits until everything is drawn since prepare(). False if something had no room: its buffers
    /// have grown then, and the frame begins again at prepare().
    [[nodiscard]] bool finish_or_grow();

    /// From now on, kernels over the pixels blend those of the slice alone: see
    /// Frame::memory_bytes.
    void set_slice(const cellist::Slice& slice);

    /// The kernels of a pass: `source` defines OIT_TARGET, OIT_TARGET_PASS and oit_store (see
    /// surface.clh), where OIT_STORES is defined. `uses` are containers and types, as in
    /// cellist::Kernel.
    template <class... Uses>
    [[nodiscard]] raster::Pass pass(std::string_view source, const std::string& file_name,
                                    const Uses&... uses) const {
        return with_node_type(layout_.words, [&]<class Node>(const Node*) {
            return raster::Pass(device_, sampling(), pass_text(source), file_name,
                                cellist::type<OitFrame>, cellist::type<Material>,
                                cellist::type<Node>, uses...);
        });
    }

    /// Enqueues a pass over all transparent fragments; `targets` are those of OIT_TARGET.
    template <class... Targets>
    void draw(raster::Pass& pass, const Targets&... targets) {
        transparent_.draw(pass, targets..., constants_, materials_, geometry_.normals(), tints_,
                          opacities_, opaque_ ? opaque_->depth_bits : no_depth_bits_);
    }

    /// A kernel over the pixels: its last parameters are OIT_SCREEN (see blend.clh).
    template <class... Uses>
    [[nodiscard]] cellist::Kernel screen_kernel(std::string_view source,
                                                const std::string& file_name,
                                                const std::string& name,
                                                const Uses&... uses) const {
        return with_node_type(layout_.words, [&]<class Node>(const Node*) {
            return raster::make_kernel(device_, screen_source(source, file_name), name,
                                       cellist::type<OitFrame>, cellist::type<Material>,
                                       cellist::type<Node>, uses...);
        });
    }

    /// Enqueues such a kernel; `args` are those in front of OIT_SCREEN.
    template <class... Args>
    void run_on_screen(cellist::Kernel& step, const Args&... args) {
        run_on(screen_, step, args...);
    }

    /// The same, but each work-item, which is a group of its own, takes `places` of a row.
    template <class... Args>
    void run_on_strips(std::size_t places, cellist::Kernel& step, const Args&... args) {
        cellist::Range strips((screen_.global[0] + places - 1) / places, screen_.global[1],
                              screen_.global[2]);
        strips.local = {1, 1, 1};
        run_on(strips, step, args...);
    }

    /// Averages samples that were blended on their own. Does not block.
    void average_samples();

    [[nodiscard]] const cellist::Device& device() const { return device_; }
    [[nodiscard]] const Frame& frame() const { return frame_; }
    [[nodiscard]] const FrameFeatures& features() const { return features_; }
    [[nodiscard]] const NodeLayout& layout() const { return layout_; }
    /// Floats for what is blended of a pixel: see blend.clh.
    [[nodiscard]] std::uint32_t state_floats() const {
        return oit::state_floats(frame_.quality, features_);
    }
    /// Of all pixels of all eyes.
    [[nodiscard]] std::size_t samples() const {
        return frame_.pixels() * static_cast<std::size_t>(frame_.quality.samples);
    }
    /// Width, height and eyes: a cell for each pixel.
    [[nodiscard]] cellist::Shape shape() const;
    /// The linear image, eye by eye, row by row from the top. With Quality::reduce, two vectors a
    /// pixel: what the transparent surfaces add, and the part of the light behind that they let
    /// pass.
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const { return image_; }
    /// Replaces the image of an eye. Blocks.
    void set_image(std::span<const cl_float4> pixels, std::size_t eye) {
        image_.upload(pixels, eye * pixels.size());
    }
    /// The least depth of the opaque surfaces in each sample, as the bits of floats; null where
    /// there are none.
    [[nodiscard]] const cellist::Buffer<cl_uint>* depth_bits() const {
        return opaque_ ? &opaque_->depth_bits : nullptr;
    }
    /// Geometry, projection, opaque surfaces and image.
    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    template <class... Args>
    void run_on(const cellist::Range& range, cellist::Kernel& step, const Args&... args) {
        const cellist::Buffer<cl_float4>& image = sample_image_ ? *sample_image_ : image_;
        if (draws_exactly())
            transparent_.run(step, range, args..., constants_, image);
        else if (opaque_)
            step.run(range, args..., constants_, projection_.views(), opaque_->depth_bits,
                     opaque_->colour, image);
        else
            step.run(range, args..., constants_, projection_.views(), image);
    }

    // What only a frame with opaque surfaces has.
    struct Opaque {
        // Without Quality::reduce.
        struct Passes {
            // The nearest piece in each sample, by 64-bit atomics.
            struct Nearest {
                raster::Pass pass;
                cellist::Buffer<cl_ulong> owners;
            };
            // Without these: the least depth, then the piece that is there.
            struct InTwo {
                raster::Pass depth;
                raster::Pass owner;
                cellist::Buffer<cl_uint> owners;
            };
            raster::Triangles triangles;
            std::optional<Nearest> nearest;
            std::optional<InTwo> in_two;
            cellist::Kernel colour;
            cellist::Range screen;

            [[nodiscard]] std::uint64_t device_bytes() const {
                return triangles.device_bytes() +
                       (nearest ? raster::bytes_of(nearest->owners) : 0) +
                       (in_two ? raster::bytes_of(in_two->owners) : 0);
            }
            explicit Passes(const FragmentSource& source);
        };
        std::optional<Passes> passes;
        cellist::Buffer<cl_uint> depth_bits;  ///< of each sample
        cellist::Buffer<cl_float4> colour;

        explicit Opaque(const FragmentSource& source);
    };

    void draw_opaque();
    [[nodiscard]] bool draws_exactly() const { return frame_.quality.coverage == Coverage::exact; }
    [[nodiscard]] raster::Sampling sampling() const;
    [[nodiscard]] cellist::Kernel opaque_colour_kernel() const;
    // The parts, after the macros that they name.
    [[nodiscard]] std::string with_defines(std::initializer_list<std::string_view> parts) const;
    [[nodiscard]] raster::Pass opaque_pass(std::string_view source,
                                           const std::string& file_name) const;
    [[nodiscard]] std::string pass_text(std::string_view source) const;
    [[nodiscard]] cellist::Source screen_source(std::string_view source,
                                                const std::string& file_name) const;

    const cellist::Device& device_;
    const Frame& frame_;
    FrameFeatures features_;
    NodeLayout layout_;
    OitFrame constants_;
    std::string defines_;
    raster::SetupKernels setup_;
    raster::Geometry geometry_;
    raster::Projection projection_;
    raster::Triangles transparent_;
    cellist::Buffer<Material> materials_;
    // Of vertices, as geometry_ has them. One float, which no kernel reads, if no model has any.
    cellist::Buffer<cl_float> opacities_;
    cellist::Buffer<cl_float> tints_;         ///< 3 each
    cellist::Buffer<cl_uint> no_depth_bits_;  ///< stands in for those of Opaque
    std::unique_ptr<Opaque> opaque_;
    cellist::Range screen_;
    cellist::Buffer<cl_float4> image_;
    std::optional<cellist::Buffer<cl_float4>>
        sample_image_;  ///< of each pixel, with per-sample resolve
    std::optional<cellist::Kernel> average_;
};

}  // namespace oit
