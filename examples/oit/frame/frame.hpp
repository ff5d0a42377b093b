// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "frame/node_format.hpp"
#include "raster/share.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace oit {

/// Where the fragments of a pixel with several samples are blended.
enum class Resolve {
    per_pixel,   ///< in one work-item, which blends all samples and averages them
    per_sample,  ///< in a work-item for each sample; another pass averages them
};

/// What of a pixel a fragment covers.
enum class Coverage {
    samples,  ///< a bit for each of Quality::samples
    exact,    ///< an area: the part of its triangle in the pixel
};

/// A thin lens around the eye, for depth of field.
struct Lens {
    double radius = 0;  ///< of the aperture; the scene has radius 1
    /// The depth that is in focus, not 0. It may be infinite, or negative: behind the eye.
    double focus = 1;
};

/// An OpenCL C function of the user's that blends: see blend.clh.
struct BlendFunction {
    std::string text;
    std::string file_name;
};

/// What is given up for what, and how it is drawn; the exact picture is the default.
struct Quality {
    int samples = 1;  ///< of a pixel: 1, 2, 4 or 8; 1 with exact coverage
    Coverage coverage = Coverage::samples;
    Resolve resolve = Resolve::per_pixel;
    /// Fragments have the slopes of their depth, and each sample blends them in the order that it
    /// sees.
    bool depth_range = false;
    NodeFormat format = NodeFormat::float32;
    DepthScale depth_scale = DepthScale::linear;
    /// Nearest layers that are blended in each pixel; none means all.
    std::optional<std::uint32_t> layers = {};
    /// Blending ends where no more than this part of the light passes.
    float epsilon = 0;
    /// Transparent surfaces are drawn with as many times fewer pixels a side, 1, 2 or 4, and
    /// enlarged along the edges of the opaque ones: see reduction.hpp.
    int reduce = 1;
    /// Rays of each pixel through different places of Frame::lens.
    std::uint32_t lens_rays = 32;
    /// What the method is compiled for, of MethodInfo::sizes; none means its default.
    std::optional<std::uint32_t> size = {};

    [[nodiscard]] bool operator==(const Quality& other) const = default;
};

/// Everything that determines a picture; the device and the reference draw the same.
struct Frame {
    const Scene& scene;
    std::vector<raster::View> views;  ///< one for each eye, all of the same size
    double time = 0;                  ///< in seconds
    Quality quality = {};
    std::optional<BlendFunction> blend_function = {};  ///< of Blend::user
    std::optional<Lens> lens = {};                     ///< none: a pinhole
    /// Pixels on each side of the views that are drawn only because a lens blurs them into others.
    int margin = 0;
    /// The most that a method may keep on the device. Lists are built and blended in slices then.
    std::optional<std::uint64_t> memory_bytes = {};
    /// The part of the transparent triangles that this process draws.
    raster::Share share = {};

    /// Opaque surfaces are fragments, as all others are. Otherwise they are drawn first, and hide
    /// fragments.
    [[nodiscard]] bool stores_opaque() const {
        return lens.has_value() || quality.coverage == Coverage::exact;
    }
    [[nodiscard]] int width() const { return views.front().width; }
    [[nodiscard]] int height() const { return views.front().height; }
    /// Of all eyes.
    [[nodiscard]] std::size_t pixels() const {
        return views.size() * static_cast<std::size_t>(width()) *
               static_cast<std::size_t>(height());
    }
};

}  // namespace oit
