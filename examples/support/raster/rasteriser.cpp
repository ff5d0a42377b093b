#include "raster/rasteriser.hpp"

#include <initializer_list>
#include <span>

#include "input_error.hpp"
#include "raster_kernels.hpp"

namespace raster {
namespace {

constexpr int tile_pixels = RASTER_TILE_PIXELS;

std::span<const cl_float> floats_of(const std::vector<glm::vec3>& vectors) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(cl_float));
    if (vectors.empty()) return {};
    return {&vectors.front().x, 3 * vectors.size()};
}

std::span<const cl_uint> indices_of(const support::Mesh& mesh) {
    if (mesh.triangles.empty()) return {};
    return {mesh.triangles.front().data(), 3 * mesh.triangles.size()};
}

cl_uint checked_count(std::size_t count, const char* what) {
    constexpr std::size_t limit = 0xFFFFFFFF / 3;
    if (count > limit)
        throw support::InputError("the mesh has " + std::to_string(count) + " " + what +
                                  ", the limit is " + std::to_string(limit));
    return static_cast<cl_uint>(count);
}

std::string joined(std::initializer_list<std::string_view> parts) {
    std::string text = "#include <cellist/lists.clh>\n";
    for (const std::string_view part : parts) text.append(part).append("\n");
    return text;
}

cellist::Source setup_source(const cellist::Device& device) {
    return {.text = joined({kernels::geometry_h, kernels::transform_cl, kernels::triangle_clh,
                            kernels::scan_clh, kernels::bin_cl}),
            .file_name = "raster_setup.cl",
            .options = build_options(device)};
}

}  // namespace

DeviceMesh::DeviceMesh(const cellist::Device& device, const support::Mesh& mesh)
    : positions(device, floats_of(mesh.positions)),
      normals(device, floats_of(mesh.normals)),
      indices(device, indices_of(mesh)),
      vertices(checked_count(mesh.positions.size(), "vertices")),
      triangles(checked_count(mesh.triangles.size(), "triangles")) {}

std::uint64_t DeviceMesh::bytes() const {
    return (positions.size() + normals.size()) * sizeof(cl_float) +
           indices.size() * sizeof(cl_uint);
}

bool divides_exactly(const cellist::Device& device) {
    const auto devices = device.context().getInfo<CL_CONTEXT_DEVICES>();
    for (const cl::Device& one : devices)
        if ((one.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) == 0)
            return false;
    return true;
}

std::string build_options(const cellist::Device& device) {
    return divides_exactly(device) ? "-cl-fp32-correctly-rounded-divide-sqrt" : "";
}

cellist::Source Pass::pass_source(const cellist::Device& device, std::string_view source,
                                  const std::string& name) {
    return {.text = joined({kernels::geometry_h, kernels::triangle_clh, kernels::scan_clh, source,
                            kernels::draw_clh}),
            .file_name = name,
            .options = build_options(device)};
}

SetupKernels::SetupKernels(const cellist::Device& device)
    : transform(device, setup_source(device), "raster_transform", cellist::type<View>,
                cellist::type<RasterVertex>, cellist::type<RasterBinned>),
      bin(device, setup_source(device), "raster_bin", cellist::type<View>,
          cellist::type<RasterVertex>, cellist::type<RasterBinned>) {}

Drawing::Drawing(const cellist::Device& device, SetupKernels& kernels, const DeviceMesh& mesh,
                 const View& view)
    : kernels_(kernels),
      mesh_(mesh),
      view_(view),
      vertices_(device, mesh.vertices),
      bins_(device, {static_cast<std::uint64_t>((view.width + tile_pixels - 1) / tile_pixels),
                     static_cast<std::uint64_t>((view.height + tile_pixels - 1) / tile_pixels)}) {}

void Drawing::transform() {
    kernels_.transform.run(cellist::Range::padded(mesh_.vertices, 64), view_, mesh_.positions,
                           mesh_.vertices, vertices_);
}

void Drawing::bin() {
    const cellist::BuildReport report =
        bins_.build(kernels_.bin, cellist::Range::padded(mesh_.triangles, 64), view_, vertices_,
                    mesh_.positions, mesh_.indices, mesh_.triangles);
    has_bins_ = report.stored > 0;
}

cellist::Range Drawing::tile_rows() const {
    const auto across = static_cast<std::size_t>(bins_.shape().extent(0));
    const auto down = static_cast<std::size_t>(bins_.shape().extent(1));
    cellist::Range range(across, down * tile_pixels);
    range.local = {1, tile_pixels, 1};
    return range;
}

std::uint64_t Drawing::device_bytes() const {
    return vertices_.size() * sizeof(RasterVertex) + bins_.pool_bytes();
}

}  // namespace raster
