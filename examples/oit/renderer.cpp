#include "renderer.hpp"

#include <bit>
#include <chrono>
#include <limits>
#include <string>
#include <string_view>

#include "oit_kernels.hpp"

namespace oit {
namespace {

// Up to here the nearest layers are kept in registers while the list is visited once; for more,
// sorting the lists is faster.
constexpr std::uint32_t nearest_max = 16;

constexpr cl_uint infinity_bits = std::bit_cast<cl_uint>(std::numeric_limits<cl_float>::infinity());

bool picks_nearest(const Frame& frame) { return frame.layers && *frame.layers <= nearest_max; }

std::string defines(const Frame& frame) { return frame.floor ? "#define OIT_OPAQUE\n" : ""; }

std::string layer_defines(const Frame& frame) {
    if (!frame.layers) return {};
    const std::string name = picks_nearest(frame) ? "OIT_NEAREST" : "OIT_LAYERS";
    return "#define " + name + " " + std::to_string(*frame.layers) + "\n";
}

std::string shaded(std::string_view pass) {
    return std::string(kernels::shading_clh).append("\n").append(pass);
}

cellist::Shape shape_of(const Frame& frame) {
    return {static_cast<std::uint64_t>(frame.view.width),
            static_cast<std::uint64_t>(frame.view.height)};
}

std::size_t pixels_of(const Frame& frame) {
    return static_cast<std::size_t>(shape_of(frame).cells());
}

cellist::Source resolve_source(const cellist::Device& device, const Frame& frame) {
    return {.text = "#include <cellist/lists.clh>\n" + defines(frame) + layer_defines(frame) +
                    "#pragma OPENCL FP_CONTRACT OFF\n" + shaded(kernels::resolve_cl),
            .file_name = "resolve.cl",
            .options = raster::build_options(device)};
}

}  // namespace

Renderer::Opaque::Opaque(const cellist::Device& device, raster::SetupKernels& setup,
                         const Frame& frame)
    : mesh(device, *frame.floor),
      drawing(device, setup, mesh, frame.view),
      depth_pass(device, kernels::opaque_depth_cl, "opaque_depth.cl"),
      colour_pass(device, shaded(kernels::opaque_colour_cl), "opaque_colour.cl",
                  cellist::type<Look>),
      depth_bits(device, pixels_of(frame)),
      colour(device, pixels_of(frame)) {}

Renderer::Renderer(const cellist::Device& device, const Frame& frame)
    : device_(device),
      frame_(frame),
      sorts_(!picks_nearest(frame)),
      setup_(device),
      mesh_(device, frame.mesh),
      drawing_(device, setup_, mesh_, frame.view),
      fragments_(device, shape_of(frame)),
      transparent_pass_(device, defines(frame) + shaded(kernels::transparent_cl), "transparent.cl",
                        fragments_, cellist::type<Look>),
      resolve_(device, resolve_source(device, frame), "oit_resolve", fragments_,
               cellist::type<raster::View>, cellist::type<Look>),
      image_(device, pixels_of(frame)) {
    if (frame.floor) opaque_ = std::make_unique<Opaque>(device, setup_, frame);
}

PassTimes Renderer::draw() {
    using Clock = std::chrono::steady_clock;
    const auto ms = [](Clock::duration d) {
        return std::chrono::duration<double, std::milli>(d).count();
    };
    device_.finish();
    const auto start = Clock::now();
    drawing_.transform();
    if (opaque_) opaque_->drawing.transform();
    device_.finish();
    const auto transformed = Clock::now();
    insert_fragments();
    device_.finish();
    const auto inserted = Clock::now();
    resolve();
    device_.finish();
    const auto end = Clock::now();
    return {ms(transformed - start), ms(inserted - transformed), ms(end - inserted),
            ms(end - start)};
}

void Renderer::insert_fragments() {
    drawing_.bin();
    if (!opaque_) {
        fragments_.build(
            [&] { drawing_.draw(transparent_pass_, fragments_, frame_.look, mesh_.normals); });
        return;
    }
    opaque_->drawing.bin();
    opaque_->depth_bits.fill(infinity_bits);
    opaque_->drawing.draw(opaque_->depth_pass, opaque_->depth_bits);
    opaque_->drawing.draw(opaque_->colour_pass, opaque_->depth_bits, opaque_->colour, frame_.look);
    fragments_.build([&] {
        drawing_.draw(transparent_pass_, fragments_, frame_.look, mesh_.normals,
                      opaque_->depth_bits);
    });
}

void Renderer::resolve() {
    if (sorts_) fragments_.sort(&Fragment::depth);
    const auto padded = [](int side) { return static_cast<std::size_t>((side + 7) / 8 * 8); };
    cellist::Range range(padded(frame_.view.width), padded(frame_.view.height));
    range.local = {8, 8, 1};
    if (opaque_)
        resolve_.run(range, fragments_, frame_.view, frame_.look, opaque_->depth_bits,
                     opaque_->colour, image_);
    else
        resolve_.run(range, fragments_, frame_.view, frame_.look, image_);
}

std::uint64_t Renderer::device_bytes() const {
    std::uint64_t bytes = fragments_.pool_bytes() + drawing_.device_bytes() +
                          image_.size() * sizeof(cl_float4) + mesh_.bytes();
    if (opaque_)
        bytes += opaque_->mesh.bytes() + opaque_->drawing.device_bytes() +
                 opaque_->depth_bits.size() * sizeof(cl_uint) +
                 opaque_->colour.size() * sizeof(cl_float4);
    return bytes;
}

}  // namespace oit
