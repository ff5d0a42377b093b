// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <cellist/cellist.hpp>

#include "frame/fragment_source.hpp"

namespace oit {

/// Transparent surfaces at reduced resolution, in front of opaque ones at full resolution.
///
/// A pixel of the reduced image stands for a block of the full one. It takes the fragments in front
/// of the farthest opaque surface of its block, so that nothing is lost that is seen in any of its
/// pixels. What they add, and what they let pass, is enlarged to the full image: each pixel takes a
/// mean of the reduced pixels around it, weighted by nearness and by how well their opaque depth
/// agrees with its own (joint bilateral upsampling: Kopf, Cohen, Lischinski, Uyttendaele, SIGGRAPH
/// 2007).
class Reduction {
public:
    /// Refers to the device and the frame, which must outlive it. Throws InputError where the frame
    /// has several samples a pixel.
    Reduction(const cellist::Device& device, const Frame& frame);

    /// The frame whose transparent surfaces are drawn.
    [[nodiscard]] const Frame& reduced() const { return reduced_; }

    /// Takes the frame's views and time, which may have changed. Blocks.
    void follow();
    void transform() { source_.projection().transform(); }
    /// Draws the opaque surfaces, and writes their depths for the reduced frame. Blocks.
    void draw_opaque(const FragmentSource& transparent);
    /// Enlarges what came of the reduced frame over the opaque surfaces. Does not block.
    void enlarge(const FragmentSource& transparent);

    /// The linear image at full resolution, eye by eye, row by row from the top.
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const { return source_.image(); }
    [[nodiscard]] std::uint64_t device_bytes() const { return source_.device_bytes(); }

private:
    const Frame& frame_;
    Frame reduced_;
    Scene opaque_scene_;
    Frame opaque_;
    FragmentSource source_;  ///< of the opaque surfaces
    cellist::Kernel backdrop_;
    cellist::Kernel shrink_;
    cellist::Kernel enlarge_;
};

}  // namespace oit
