// SPDX-License-Identifier: MIT
#include "frame/reduction.hpp"

#include "input_error.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// The view whose pixels are blocks of so many pixels a side, the last of them partly outside.
raster::View reduced_view(const raster::View& view, int block) {
    raster::View reduced = view;
    reduced.width = (view.width + block - 1) / block;
    reduced.height = (view.height + block - 1) / block;
    const auto scale_row = [&](cl_float(&row)[4], int side, int reduced_side) {
        // Clip coordinates are relative to the middle of the image, which moves if blocks stand
        // out.
        const double shift =
            0.5 * RASTER_SUBPIXELS * (static_cast<double>(side) / block - reduced_side);
        for (int i = 0; i < 4; ++i)
            row[i] = static_cast<cl_float>(static_cast<double>(row[i]) / block +
                                           shift * static_cast<double>(view.row_w[i]));
    };
    scale_row(reduced.row_x, view.width, reduced.width);
    scale_row(reduced.row_y, view.height, reduced.height);
    for (int i = 0; i < 3; ++i) {
        reduced.ray_origin[i] +=
            0.5F * static_cast<cl_float>(block - 1) * (view.ray_x[i] + view.ray_y[i]);
        reduced.ray_x[i] *= static_cast<cl_float>(block);
        reduced.ray_y[i] *= static_cast<cl_float>(block);
    }
    return reduced;
}

std::vector<raster::View> reduced_views(const Frame& frame) {
    std::vector<raster::View> views = frame.views;
    for (raster::View& view : views) view = reduced_view(view, frame.quality.reduce);
    return views;
}

Frame reduced_frame(const Frame& frame) {
    if (frame.quality.samples > 1)
        throw support::InputError(
            "surfaces at reduced resolution have one sample per pixel: draw with fewer samples, or "
            "without reducing");
    Frame reduced = frame;
    reduced.views = reduced_views(frame);
    return reduced;
}

// The opaque surfaces alone.
Scene opaque_part(const Scene& scene) {
    Scene opaque{.materials = scene.materials, .lighting = scene.lighting};
    std::vector<std::size_t> places(scene.models.size(), scene.models.size());
    for (Instance instance : scene.instances) {
        if (!scene.is_opaque(instance)) continue;
        std::size_t& place = places.at(instance.model);
        if (place == scene.models.size()) {
            place = opaque.models.size();
            opaque.models.push_back(scene.models[instance.model]);
        }
        instance.model = place;
        opaque.instances.push_back(instance);
    }
    return opaque;
}

cellist::Source kernel_source(const FragmentSource& source, int block) {
    std::string defines = define("OIT_BLOCK", block);
    if (source.depth_bits()) defines += "#define OIT_HAS_OPAQUE\n";
    return {.text = defines + std::string(kernels::reduce_cl), .file_name = "reduce.cl"};
}

cellist::Range pixels_of(const Frame& frame) {
    return {static_cast<std::size_t>(frame.width()), static_cast<std::size_t>(frame.height()),
            frame.views.size()};
}

}  // namespace

Reduction::Reduction(const cellist::Device& device, const Frame& frame)
    : frame_(frame),
      reduced_(reduced_frame(frame)),
      opaque_scene_(opaque_part(frame.scene)),
      opaque_{.scene = opaque_scene_, .views = frame.views, .time = frame.time},
      source_(device, opaque_),
      backdrop_(source_.screen_kernel(kernels::backdrop_cl, "backdrop.cl", "oit_backdrop")),
      shrink_(device, kernel_source(source_, frame.quality.reduce), "oit_shrink"),
      enlarge_(device, kernel_source(source_, frame.quality.reduce), "oit_enlarge") {}

void Reduction::follow() {
    reduced_.views = reduced_views(frame_);
    reduced_.time = opaque_.time = frame_.time;
    opaque_.views = frame_.views;
    source_.follow();
}

void Reduction::draw_opaque(const FragmentSource& transparent) {
    // The reduced frame begins with what is drawn here, so nothing may be missing.
    do source_.prepare();
    while (!source_.finish_or_grow());
    source_.run_on_screen(backdrop_);
    if (const cellist::Buffer<cl_uint>* depths = source_.depth_bits())
        shrink_.run(pixels_of(reduced_), *depths, *transparent.depth_bits(),
                    static_cast<cl_int>(opaque_.width()), static_cast<cl_int>(opaque_.height()));
}

void Reduction::enlarge(const FragmentSource& transparent) {
    const auto width = static_cast<cl_int>(reduced_.width());
    const auto height = static_cast<cl_int>(reduced_.height());
    if (const cellist::Buffer<cl_uint>* depths = source_.depth_bits())
        enlarge_.run(pixels_of(opaque_), transparent.image(), *transparent.depth_bits(), *depths,
                     source_.image(), width, height);
    else
        enlarge_.run(pixels_of(opaque_), transparent.image(), source_.image(), width, height);
}

}  // namespace oit
