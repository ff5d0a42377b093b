// SPDX-License-Identifier: MIT
#include "methods/view_mean.hpp"

#include "frame/views.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr std::size_t lens_views = 1024;
constexpr std::size_t samples_across = 64;  // a pixel, and as many down

Frame pinhole_frame(const Frame& frame) {
    Frame pinhole = frame;
    pinhole.lens.reset();
    pinhole.memory_bytes.reset();
    pinhole.quality = {};
    return pinhole;
}

// Views through the points of a regular grid in each pixel.
ViewMean::Views views_of_samples(const Frame& frame) {
    return [&frame](std::size_t i) {
        const auto offset = [](std::size_t n) {
            return (static_cast<double>(n) + 0.5) / samples_across - 0.5;
        };
        std::vector<raster::View> views = frame.views;
        for (raster::View& view : views)
            view = moved_by(view, {offset(i % samples_across), offset(i / samples_across)});
        return views;
    };
}

}  // namespace

ViewMean::ViewMean(const cellist::Device& device, const Frame& frame)
    : frame_(pinhole_frame(frame)),
      renderer_(device, frame_),
      add_(device,
           cellist::Source{.text = std::string(kernels::view_mean_cl), .file_name = "view_mean.cl"},
           "oit_add_picture"),
      image_(device, frame_.pixels()) {}

void ViewMean::draw(double time, std::size_t count, const Views& views,
                    const std::function<void(double)>& progress) {
    frame_.time = time;
    image_.fill({{0, 0, 0, 0}});
    const auto part = 1 / static_cast<cl_float>(count);
    for (std::size_t i = 0; i < count; ++i) {
        progress(static_cast<double>(i) / static_cast<double>(count));
        frame_.views = views(i);
        renderer_.draw_changed();
        add_.run(cellist::Range::padded(image_.size(), 64), renderer_.picture(), image_,
                 static_cast<cl_uint>(image_.size()), part);
    }
}

Reference ViewMean::reference() const {
    Reference reference;
    reference.width = static_cast<std::size_t>(frame_.width());
    reference.height = static_cast<std::size_t>(frame_.height());
    for (const cl_float4& pixel : image_.download())
        reference.image.emplace_back(pixel.s[0], pixel.s[1], pixel.s[2]);
    reference.ambiguous.resize(reference.image.size());
    return reference;
}

std::uint64_t ViewMean::device_bytes() const {
    return renderer_.device_bytes() + raster::bytes_of(image_);
}

ViewMean::Views views_through_lens(const Frame& frame, std::size_t count) {
    return [&frame, count](std::size_t i) {
        std::vector<raster::View> views = frame.views;
        for (raster::View& view : views)
            view = through_lens(view, *frame.lens, place_on_disc(i, count));
        return views;
    };
}

std::size_t reference_views(const Frame& frame) {
    if (frame.lens) return lens_views;
    return frame.quality.coverage == Coverage::exact ? samples_across * samples_across : 0;
}

Reference reference_of(const cellist::Device& device, const Frame& frame,
                       const std::function<void(double)>& progress) {
    const std::size_t count = reference_views(frame);
    if (count == 0) return draw_reference(frame, {.progress = progress});
    ViewMean mean(device, frame);
    mean.draw(frame.time, count,
              frame.lens ? views_through_lens(frame, count) : views_of_samples(frame), progress);
    return mean.reference();
}

}  // namespace oit
