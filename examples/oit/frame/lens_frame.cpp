// SPDX-License-Identifier: MIT
#include "frame/lens_frame.hpp"

#include <algorithm>
#include <cmath>

#include "frame/views.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// The radius of the largest circle of confusion in pixels, but at most the widest margin.
int margin_of(const Frame& frame) {
    const FrameFeatures features = features_of(frame);
    const auto nearness = [](float depth) { return 1 / static_cast<double>(depth); };
    const double focus = 1 / frame.lens->focus;
    const double circle = focal_length_pixels(frame.views.front()) * frame.lens->radius *
                          std::max(std::abs(nearness(features.least_depth) - focus),
                                   std::abs(nearness(features.greatest_depth) - focus));
    const int widest =
        std::min(static_cast<int>(LensFrame::margin_max * std::min(frame.width(), frame.height())),
                 (RASTER_SIDE_MAX - std::max(frame.width(), frame.height())) / 2);
    // Up to half a pixel, nothing moves to another pixel.
    return circle <= 0.5 ? 0 : static_cast<int>(std::min<double>(std::ceil(circle), widest));
}

std::vector<raster::View> widened_views(const Frame& frame, int margin) {
    std::vector<raster::View> views = frame.views;
    for (raster::View& view : views) {
        // Clip coordinates are relative to the middle of the image, which stays.
        view.width += 2 * margin;
        view.height += 2 * margin;
        for (int i = 0; i < 3; ++i)
            view.ray_origin[i] -= static_cast<cl_float>(margin) * (view.ray_x[i] + view.ray_y[i]);
    }
    return views;
}

Frame widened_frame(const Frame& frame) {
    Frame widened = frame;
    widened.quality.depth_range = true;
    widened.margin = margin_of(frame);
    widened.views = widened_views(frame, widened.margin);
    return widened;
}

}  // namespace

LensFrame::LensFrame(const cellist::Device& device, const Frame& frame)
    : frame_(frame),
      widened_(widened_frame(frame)),
      cut_out_(device,
               cellist::Source{.text = std::string(kernels::cut_out_cl), .file_name = "cut_out.cl"},
               "oit_cut_out"),
      image_(device, frame.pixels()) {}

void LensFrame::follow() {
    widened_.views = widened_views(frame_, widened_.margin);
    widened_.time = frame_.time;
}

void LensFrame::cut_out(const FragmentSource& source) {
    cut_out_.run(cellist::Range(frame_.width(), frame_.height(), frame_.views.size()),
                 source.image(), image_, static_cast<cl_int>(widened_.margin));
}

}  // namespace oit
