// SPDX-License-Identifier: MIT
#include "frame/fragment_source.hpp"

#include "frame/blend_function.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr cl_uint no_owner = 0xFFFFFFFF;
constexpr cl_ulong no_nearest = cl_ulong{infinity_bits} << 32 | no_owner;

std::string joined(std::initializer_list<std::string_view> parts) {
    std::string text;
    for (const std::string_view part : parts) text.append(part).append("\n");
    return text;
}

// Of the lines `#define NAME ...`, those whose name is in the text. Programs that differ only in
// other macros are one program, which the driver compiles once.
std::string defines_named(std::string_view defines, std::string_view text) {
    constexpr std::string_view directive = "#define ";
    std::string named;
    while (!defines.empty()) {
        const std::string_view line = defines.substr(0, defines.find('\n') + 1);
        const std::string_view rest = line.substr(directive.size());
        if (text.find(rest.substr(0, rest.find_first_of(" \n"))) != std::string_view::npos)
            named += line;
        defines.remove_prefix(line.size());
    }
    return named;
}

std::vector<const support::Mesh*> meshes_of(const Scene& scene) {
    std::vector<const support::Mesh*> meshes;
    for (const Model& model : scene.models) meshes.push_back(&model.mesh);
    return meshes;
}

std::vector<raster::Placed> placed_at(const Scene& scene, double time) {
    std::vector<raster::Placed> placed;
    for (const Instance& instance : scene.instances)
        placed.push_back({.mesh = instance.model,
                          .to_world = transform_at(instance, time),
                          .tag = static_cast<cl_uint>(instance.material)});
    return placed;
}

// The instances of surfaces that are drawn first, or of those whose fragments are stored.
std::vector<std::size_t> chosen(const Frame& frame, bool drawn_first) {
    const Scene& scene = frame.scene;
    std::vector<std::size_t> instances;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
        if ((scene.is_opaque(scene.instances[i]) && !frame.stores_opaque()) == drawn_first)
            instances.push_back(i);
    return instances;
}

std::vector<cl_float> opacities_of(const Scene& scene) {
    std::vector<cl_float> opacities;
    for (const Model& model : scene.models)
        if (model.opacities.empty())
            opacities.insert(opacities.end(), model.mesh.positions.size(), 1.0F);
        else
            opacities.insert(opacities.end(), model.opacities.begin(), model.opacities.end());
    return opacities;
}

std::vector<cl_float> tints_of(const Scene& scene) {
    std::vector<cl_float> tints;
    for (const Model& model : scene.models) {
        if (model.tints.empty()) tints.insert(tints.end(), 3 * model.mesh.positions.size(), 1.0F);
        for (const glm::vec3& tint : model.tints)
            tints.insert(tints.end(), {tint.x, tint.y, tint.z});
    }
    return tints;
}

// The background is a gradient from the top of the image to its bottom: it goes on in the margin.
Lighting lighting_of(const Frame& frame) {
    Lighting lighting = frame.scene.lighting;
    const auto inner = static_cast<cl_float>(frame.height() - 2 * frame.margin);
    const cl_float beyond = static_cast<cl_float>(frame.margin) / inner;
    for (int i = 0; i < 3; ++i) {
        const cl_float more = beyond * (lighting.background_bottom[i] - lighting.background_top[i]);
        lighting.background_top[i] -= more;
        lighting.background_bottom[i] += more;
    }
    return lighting;
}

OitFrame constants_of(const Frame& frame, const FrameFeatures& features) {
    return {.lighting = lighting_of(frame),
            .alpha = features.alpha,
            .least_depth = features.least_depth,
            .greatest_depth = features.greatest_depth,
            .colour_max = features.colour_max,
            .epsilon = frame.quality.epsilon,
            .first_pixel = 0,
            .end_pixel = static_cast<cl_uint>(frame.pixels())};
}

cellist::Range screen_of(const Frame& frame, std::size_t samples_across) {
    const auto padded = [](std::size_t side) { return (side + 7) / 8 * 8; };
    cellist::Range range(padded(static_cast<std::size_t>(frame.width()) * samples_across),
                         padded(static_cast<std::size_t>(frame.height())), frame.views.size());
    range.local = {8, 8, 1};
    return range;
}

std::size_t samples_of(const Quality& quality) { return static_cast<std::size_t>(quality.samples); }

bool is_reduced(const Frame& frame) { return frame.quality.reduce > 1; }

bool resolves_samples(const Quality& quality) {
    return quality.samples > 1 && quality.resolve == Resolve::per_sample;
}

}  // namespace

FragmentSource::Opaque::Passes::Passes(const FragmentSource& source)
    : triangles(source.device_, source.projection_, chosen(source.frame_, true)),
      colour(source.opaque_colour_kernel()),
      screen(screen_of(source.frame_, 1)) {
    if (source.device_.info().int64_atomics) {
        nearest = Nearest{source.opaque_pass(kernels::opaque_nearest_cl, "opaque_nearest.cl"),
                          cellist::Buffer<cl_ulong>(source.device_, source.samples())};
        nearest->owners.fill(no_nearest);
    } else {
        in_two = InTwo{source.opaque_pass(kernels::opaque_depth_cl, "opaque_depth.cl"),
                       source.opaque_pass(kernels::opaque_owner_cl, "opaque_owner.cl"),
                       cellist::Buffer<cl_uint>(source.device_, source.samples())};
    }
}

FragmentSource::Opaque::Opaque(const FragmentSource& source)
    : depth_bits(source.device_, source.samples()),
      colour(source.device_, is_reduced(source.frame_) ? 1 : source.samples()) {
    if (!is_reduced(source.frame_)) passes.emplace(source);
}

FragmentSource::FragmentSource(const cellist::Device& device, const Frame& frame)
    : device_(device),
      frame_(frame),
      features_(features_of(frame)),
      layout_(node_layout(frame.quality, features_)),
      constants_(constants_of(frame, features_)),
      defines_(defines_of(frame, features_) + defines_of(layout_)),
      setup_(device, sampling()),
      geometry_(device, meshes_of(frame.scene)),
      projection_(device, setup_, geometry_, placed_at(frame.scene, frame.time), frame.views),
      transparent_(device, projection_, chosen(frame, false), frame.share),
      materials_(device, frame.scene.materials),
      opacities_(device,
                 features_.opacities ? opacities_of(frame.scene) : std::vector<cl_float>(1)),
      tints_(device, features_.tints ? tints_of(frame.scene) : std::vector<cl_float>(1)),
      no_depth_bits_(device, 1),
      screen_(screen_of(frame, resolves_samples(frame.quality) ? samples_of(frame.quality) : 1)),
      image_(device, (is_reduced(frame) ? 2 : 1) * frame.pixels()) {
    if (features_.opaque) opaque_ = std::make_unique<Opaque>(*this);
    if (resolves_samples(frame.quality)) {
        sample_image_.emplace(device, frame.pixels() * samples_of(frame.quality));
        average_.emplace(
            device,
            cellist::Source{.text = with_defines({kernels::average_cl}), .file_name = "average.cl"},
            "oit_average");
    }
    if (frame.blend_function) check_blend_function(device, defines_, *frame.blend_function);
}

void FragmentSource::follow() {
    const FrameFeatures now = features_of(frame_);
    features_.least_depth = now.least_depth;
    features_.greatest_depth = now.greatest_depth;
    constants_ = constants_of(frame_, features_);
    projection_.move(placed_at(frame_.scene, frame_.time), frame_.views);
}

void FragmentSource::draw_opaque() {
    Opaque& o = *opaque_;
    Opaque::Passes& passes = *opaque_->passes;
    passes.triangles.bin();
    const auto shade = [&](const auto& owners) {
        passes.triangles.run(passes.colour, passes.screen, owners, o.depth_bits, o.colour,
                             constants_, materials_, geometry_.normals(), tints_);
    };
    if (passes.nearest) {
        auto& [pass, owners] = *passes.nearest;
        passes.triangles.draw(pass, owners);
        shade(owners);
    } else {
        auto& [depth, owner, owners] = *passes.in_two;
        o.depth_bits.fill(infinity_bits);
        owners.fill(no_owner);
        passes.triangles.draw(depth, o.depth_bits);
        passes.triangles.draw(owner, owners, o.depth_bits);
        shade(owners);
    }
}

void FragmentSource::set_slice(const cellist::Slice& slice) {
    constants_.first_pixel = static_cast<cl_uint>(slice.first_cell);
    constants_.end_pixel = static_cast<cl_uint>(slice.first_cell + slice.cells);
}

void FragmentSource::average_samples() {
    if (average_)
        average_->run(cellist::Range::padded(image_.size(), 64), *sample_image_, image_,
                      static_cast<cl_uint>(image_.size()));
}

bool FragmentSource::finish_or_grow() {
    const bool opaque = !opaque_ || !opaque_->passes || opaque_->passes->triangles.finish_or_grow();
    return transparent_.finish_or_grow() && opaque;
}

cellist::Shape FragmentSource::shape() const {
    return {static_cast<std::uint64_t>(frame_.width()), static_cast<std::uint64_t>(frame_.height()),
            frame_.views.size()};
}

raster::Sampling FragmentSource::sampling() const {
    return {.samples = frame_.quality.samples,
            .depth_range = frame_.quality.depth_range,
            .exact = draws_exactly()};
}

std::string FragmentSource::with_defines(std::initializer_list<std::string_view> parts) const {
    const std::string text = joined(parts);
    return defines_named(defines_, text) + text;
}

raster::Pass FragmentSource::opaque_pass(std::string_view source,
                                         const std::string& file_name) const {
    return raster::Pass(device_, sampling(), with_defines({kernels::shading_clh, source}),
                        file_name, cellist::type<OitFrame>, cellist::type<Material>);
}

cellist::Kernel FragmentSource::opaque_colour_kernel() const {
    const std::string text = with_defines({kernels::shading_clh, kernels::opaque_colour_cl});
    return raster::make_kernel(
        device_,
        cellist::Source{
            .text = raster::triangle_text(device_, sampling()) +
                    (device_.info().int64_atomics ? "#define OIT_NEAREST_OWNERS\n" : "") +
                    define("OIT_NO_OWNER", std::to_string(no_nearest) + "ul") + text,
            .file_name = "opaque_colour.cl",
            .options = raster::build_options(device_)},
        "oit_shade_opaque", cellist::type<OitFrame>, cellist::type<Material>);
}

std::string FragmentSource::pass_text(std::string_view source) const {
    return with_defines({"#define OIT_STORES", kernels::shading_clh, kernels::fragment_clh, source,
                         kernels::surface_clh});
}

cellist::Source FragmentSource::screen_source(std::string_view source,
                                              const std::string& file_name) const {
    const std::string head = draws_exactly()
                                 ? raster::triangle_text(device_, sampling())
                                 : "#include <cellist/lists.clh>\n#pragma OPENCL FP_CONTRACT OFF";
    return {
        .text = joined({head, defines_, kernels::shading_clh, kernels::fragment_clh,
                        blend_function_text(frame_.blend_function), kernels::blend_clh,
                        draws_exactly() ? kernels::coverage_clh : kernels::samples_clh, source}),
        .file_name = file_name,
        .options = raster::build_options(device_)};
}

std::uint64_t FragmentSource::device_bytes() const {
    using raster::bytes_of;
    std::uint64_t bytes = geometry_.device_bytes() + projection_.device_bytes() +
                          transparent_.device_bytes() + bytes_of(materials_, image_);
    if (features_.opacities) bytes += bytes_of(opacities_);
    if (features_.tints) bytes += bytes_of(tints_);
    if (sample_image_) bytes += bytes_of(*sample_image_);
    if (!opaque_) return bytes;
    bytes += bytes_of(opaque_->depth_bits, opaque_->colour);
    if (opaque_->passes) bytes += opaque_->passes->device_bytes();
    return bytes;
}

}  // namespace oit
