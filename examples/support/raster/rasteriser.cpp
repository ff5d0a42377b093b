// SPDX-License-Identifier: MIT
#include "raster/rasteriser.hpp"

#include <algorithm>
#include <initializer_list>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "input_error.hpp"
#include "raster_kernels.hpp"

namespace raster {
namespace {

constexpr std::size_t batch_size = 64;         // RASTER_BATCH in triangle.clh
constexpr std::size_t first_capacity = 16384;  // of the queues

// What suits a device. On GPUs, a work-item tests the pixels of a cell, and the work-items of a
// group share out those that are covered. On CPUs, a work-item is a loop of a thread, and scans a
// whole block.
struct Tuning {
    int block_pixels;
    std::size_t lanes;  // of a block
    std::size_t items;  // that scan blocks, for each compute unit
};

Tuning tuning_for(const cellist::Device& device) {
    if (device.info().is_gpu()) return {8, 4, 1024};
    return {32, 1, 64};
}

cl_uint checked_count(std::uint64_t count, const char* what) {
    constexpr std::uint64_t limit = 0xFFFFFFFF / 3;
    if (count > limit)
        throw support::InputError("the scene has " + std::to_string(count) + " " + what +
                                  ", the limit is " + std::to_string(limit));
    return static_cast<cl_uint>(count);
}

std::vector<Geometry::Part> parts_of(std::span<const support::Mesh* const> meshes) {
    std::vector<Geometry::Part> parts;
    std::uint64_t vertices = 0, triangles = 0;
    for (const support::Mesh* mesh : meshes) {
        const Geometry::Part part{checked_count(vertices, "vertices"),
                                  checked_count(mesh->positions.size(), "vertices"),
                                  checked_count(triangles, "triangles"),
                                  checked_count(mesh->triangles.size(), "triangles")};
        parts.push_back(part);
        checked_count(vertices += part.vertices, "vertices");
        checked_count(triangles += part.triangles, "triangles");
    }
    return parts;
}

std::vector<cl_float> floats_of(std::span<const support::Mesh* const> meshes,
                                std::vector<glm::vec3> support::Mesh::*vectors) {
    std::vector<cl_float> floats;
    for (const support::Mesh* mesh : meshes)
        for (const glm::vec3& v : mesh->*vectors) floats.insert(floats.end(), {v.x, v.y, v.z});
    return floats;
}

std::vector<cl_uint> indices_of(std::span<const support::Mesh* const> meshes) {
    std::vector<cl_uint> indices;
    cl_uint first = 0;
    for (const support::Mesh* mesh : meshes) {
        for (const auto& triangle : mesh->triangles)
            for (const std::uint32_t vertex : triangle) indices.push_back(first + vertex);
        first += static_cast<cl_uint>(mesh->positions.size());
    }
    return indices;
}

std::string joined(std::initializer_list<std::string_view> parts) {
    std::string text = "#include <cellist/lists.clh>\n#pragma OPENCL FP_CONTRACT OFF\n";
    for (const std::string_view part : parts) text.append(part).append("\n");
    return text;
}

std::string defines(const cellist::Device& device, const Sampling& sampling) {
    const Tuning tuning = tuning_for(device);
    return "#define RASTER_BLOCK_PIXELS " + std::to_string(tuning.block_pixels) +
           "\n#define RASTER_LANES " + std::to_string(tuning.lanes) + "\n#define RASTER_SAMPLES " +
           std::to_string(sampling.samples) + "\n" +
           (device.info().is_gpu() ? "#define RASTER_PROJECTS\n" : "") +
           (sampling.depth_range ? "#define RASTER_DEPTH_RANGE\n" : "") +
           (sampling.exact ? "#define RASTER_EXACT\n" : "");
}

cellist::Source setup_source(const cellist::Device& device, const Sampling& sampling) {
    return {
        .text = joined({defines(device, sampling), kernels::definitions_h, kernels::projection_clh,
                        kernels::triangle_clh, kernels::clip_clh, kernels::setup_cl}),
        .file_name = "raster_setup.cl",
        .options = build_options(device)};
}

// A row of a view times the place of the mesh. Rounded once.
void set_row(cl_float (&out)[4], const cl_float (&row)[4], const glm::dmat4& to_world) {
    const glm::dvec4 in(row[0], row[1], row[2], row[3]);
    const glm::dvec4 product = in * to_world;
    for (int i = 0; i < 4; ++i) out[i] = static_cast<cl_float>(product[i]);
}

void append_batches(std::vector<RasterBatch>& batches, std::size_t instance, cl_uint first,
                    cl_uint count, std::size_t most) {
    const auto size = static_cast<cl_uint>(most);
    for (cl_uint begin = 0; begin < count; begin += std::min(size, count - begin))
        batches.push_back({static_cast<cl_uint>(instance), first + begin,
                           first + begin + std::min(size, count - begin)});
}

// Under PoCL, a thread takes many consecutive groups at a time. Sixteenths of the batches are
// therefore interleaved, in the order of their reversed bits: no thread gets all of a dense part of
// a mesh.
std::vector<RasterBatch> in_order_for(const cellist::Device& device,
                                      std::vector<RasterBatch> batches) {
    if (device.info().is_gpu()) return batches;
    std::vector<RasterBatch> result;
    result.reserve(batches.size());
    for (const unsigned part :
         {0U, 8U, 4U, 12U, 2U, 10U, 6U, 14U, 1U, 9U, 5U, 13U, 3U, 11U, 7U, 15U}) {
        const auto at = [&](std::size_t sixteenth) {
            return batches.begin() + static_cast<std::ptrdiff_t>(batches.size() * sixteenth / 16);
        };
        result.insert(result.end(), at(part), at(part + 1));
    }
    return result;
}

cellist::Range batches_range(std::size_t batches) {
    return cellist::Range::padded(batches * batch_size, batch_size);
}

}  // namespace

// How triangles go to work-groups, a batch to each.
struct Batching {
    std::size_t triangles;  // of a batch, at most
    std::size_t items;      // of a group
    cl_int small_pixels;    // the size of triangles that the group draws
};

namespace {

// A GPU is busy with 8 large batches for each compute unit. With fewer, batches are small and
// groups large.
Batching batching_for(const cellist::Device& device, std::size_t triangles) {
    if (!device.info().is_gpu()) return {batch_size, batch_size, 32};
    const std::size_t units = device.info().compute_units;
    if (triangles >= 8 * units * batch_size) return {batch_size, batch_size, 16};
    const std::size_t groups = 6 * units;
    return {std::clamp<std::size_t>((triangles + groups - 1) / groups, 1, batch_size),
            std::min<std::size_t>(4 * batch_size, device.info().max_work_group_size), 32};
}

// The words of raster_draw for pixels that wait: see draw.clh.
cellist::LocalMemory waiting_pixels(std::size_t items) {
    constexpr std::size_t cell_area = 16;
    return cellist::LocalMemory{items * (cell_area + 1) * sizeof(cl_uint)};
}

// Of the work-items that scan blocks. On GPUs, their groups come after those of the batches.
cellist::Range block_range(const cellist::Device& device, const cellist::Range& batches) {
    const std::size_t items = device.info().compute_units * tuning_for(device).items;
    if (!device.info().is_gpu()) return cellist::Range::padded(items, 1);
    cellist::Range all = cellist::Range::padded(items, batches.local[0]);
    all.global[0] += batches.global[0];
    return all;
}

}  // namespace

Geometry::Geometry(const cellist::Device& device, std::span<const support::Mesh* const> meshes)
    : parts_(parts_of(meshes)),
      positions_(device, floats_of(meshes, &support::Mesh::positions)),
      normals_(device, floats_of(meshes, &support::Mesh::normals)),
      indices_(device, indices_of(meshes)) {}

RasterInstance instance_of(const Placed& placed, const View& view, cl_uint eye) {
    RasterInstance instance{};
    set_row(instance.row_x, view.row_x, placed.to_world);
    set_row(instance.row_y, view.row_y, placed.to_world);
    set_row(instance.row_w, view.row_w, placed.to_world);
    // Normals turn with the cofactors, by the length of which they grow.
    const glm::dmat3 m(placed.to_world);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    const double scale = std::cbrt(std::abs(glm::determinant(cofactors)));
    for (int i = 0; i < 3; ++i) {
        const double by = scale > 0 ? scale : 1;
        instance.normal_x[i] = static_cast<cl_float>(cofactors[i].x / by);
        instance.normal_y[i] = static_cast<cl_float>(cofactors[i].y / by);
        instance.normal_z[i] = static_cast<cl_float>(cofactors[i].z / by);
    }
    instance.eye = eye;
    instance.tag = placed.tag;
    return instance;
}

std::string build_options(const cellist::Device& device) {
    for (const cl::Device& one : device.context().getInfo<CL_CONTEXT_DEVICES>())
        if ((one.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) == 0)
            return "";
    return "-cl-fp32-correctly-rounded-divide-sqrt";
}

std::string triangle_text(const cellist::Device& device, const Sampling& sampling) {
    return joined({defines(device, sampling), "#define RASTER_WIDE", kernels::definitions_h,
                   kernels::projection_clh, kernels::triangle_clh, kernels::clip_clh,
                   kernels::pixel_clh, kernels::fragment_clh});
}

SetupKernels::SetupKernels(const cellist::Device& device, const Sampling& sampling)
    : transform(make_kernel(device, setup_source(device, sampling), "raster_transform")),
      bin(make_kernel(device, setup_source(device, sampling), "raster_bin")) {}

bool Pass::draws_at_once(const cellist::Device& device) { return device.info().is_gpu(); }

cellist::Source Pass::pass_source(const cellist::Device& device, const Sampling& sampling,
                                  std::string_view source, const std::string& name,
                                  EdgeBits edge_bits) {
    return {.text = joined({defines(device, sampling),
                            edge_bits == EdgeBits::wide ? "#define RASTER_WIDE" : "",
                            kernels::definitions_h, kernels::projection_clh, kernels::triangle_clh,
                            kernels::pixel_clh, kernels::fragment_clh, source, kernels::draw_clh}),
            .file_name = name,
            .options = build_options(device)};
}

// ---- Projection ------------------------------------------------------------------------------

namespace {

std::vector<RasterBatch> vertex_batches(const Geometry& geometry, std::span<const Placed> placed,
                                        std::size_t eyes) {
    std::vector<RasterBatch> batches;
    for (std::size_t i = 0; i < eyes * placed.size(); ++i) {
        const Geometry::Part& part = geometry.part(placed[i % placed.size()].mesh);
        append_batches(batches, i, part.first_vertex, part.vertices, batch_size);
    }
    return batches;
}

std::size_t projected_vertices(const Geometry& geometry, std::span<const Placed> placed,
                               std::size_t eyes) {
    std::uint64_t vertices = 0;
    for (const Placed& one : placed) vertices += eyes * geometry.part(one.mesh).vertices;
    return checked_count(vertices, "vertices in its instances");
}

}  // namespace

Projection::Projection(const cellist::Device& device, SetupKernels& kernels,
                       const Geometry& geometry, std::span<const Placed> placed,
                       std::span<const View> views)
    : kernels_(kernels),
      geometry_(geometry),
      projects_once_(!device.info().is_gpu()),
      eyes_(views.size()),
      views_(device, views),
      instances_(device, views.size() * placed.size()),
      batches_(device, vertex_batches(geometry, placed, views.size())),
      vertices_(device, projects_once_ ? projected_vertices(geometry, placed, views.size()) : 1),
      vertex_range_(batches_range(batches_.size())) {
    for (const Placed& one : placed) meshes_.push_back(one.mesh);
    move(placed, views);
}

void Projection::move(std::span<const Placed> placed, std::span<const View> views) {
    std::vector<RasterInstance> instances;
    cl_uint next = 0;
    for (cl_uint eye = 0; eye < views.size(); ++eye)
        for (const Placed& one : placed) {
            const Geometry::Part& part = geometry_.part(one.mesh);
            instances.push_back(instance_of(one, views[eye], eye));
            instances.back().vertex_offset = next - part.first_vertex;
            next += part.vertices;
        }
    instances_.upload_async(instances).wait();
    views_.upload_async(views).wait();
}

// ---- Triangles -------------------------------------------------------------------------------

std::size_t Projection::triangles_of(std::span<const std::size_t> chosen) const {
    std::size_t triangles = 0;
    for (const std::size_t i : chosen) triangles += geometry_.part(meshes_.at(i)).triangles;
    return eyes_ * triangles;
}

std::vector<RasterBatch> Projection::triangle_batches(std::span<const std::size_t> chosen,
                                                      std::size_t most) const {
    std::vector<RasterBatch> batches;
    for (std::size_t eye = 0; eye < eyes_; ++eye)
        for (const std::size_t i : chosen) {
            const Geometry::Part& part = geometry_.part(meshes_.at(i));
            append_batches(batches, eye * meshes_.size() + i, part.first_triangle, part.triangles,
                           most);
        }
    // Pieces of triangles are numbered, 8 for each.
    checked_count(8 * batches.size() * batch_size, "pieces of triangles in its instances");
    return batches;
}

namespace {

// Neighbouring batches go to different parts, so that each part has some of every region.
std::vector<RasterBatch> part_of(const std::vector<RasterBatch>& batches, const Share& share) {
    std::vector<RasterBatch> part;
    for (std::size_t i = share.index; i < batches.size(); i += share.count)
        part.push_back(batches[i]);
    return part;
}

}  // namespace

Triangles::Triangles(const cellist::Device& device, const Projection& projection,
                     std::span<const std::size_t> chosen, const Share& share)
    : Triangles(device, projection, chosen, share,
                batching_for(device, projection.triangles_of(chosen) / share.count)) {}

Triangles::Triangles(const cellist::Device& device, const Projection& projection,
                     std::span<const std::size_t> chosen, const Share& share,
                     const Batching& batching)
    : device_(device),
      projection_(projection),
      batches_(device,
               in_order_for(device, part_of(projection.triangle_batches(chosen, batching.triangles),
                                            share))),
      small_pixels_(batching.small_pixels),
      group_range_(cellist::Range::padded(batches_.size() * batching.items, batching.items)),
      block_range_(block_range(device, group_range_)),
      waiting_pixels_(waiting_pixels(group_range_.local[0])),
      queue_(device, first_capacity),
      blocks_(device, first_capacity),
      counts_(device, 1),
      may_be_without_queue_(device.info().is_gpu()) {
    counts_.fill({});
}

bool Triangles::finish_or_grow() {
    if (!counted_) {
        if (all_fitted_) return *all_fitted_;
        read_counts();
    }
    const RasterCounts counts = counted_->get().front();
    counted_.reset();
    note_ = counts.note;
    const cl_uint triangles = counts.triangles[turn_], blocks = counts.blocks[turn_];
    if (without_queue_) {
        // Nothing is known before triangles are drawn.
        without_queue_ = may_be_without_queue_ = drawn_ && triangles == 0;
        all_fitted_ = without_queue_;
        return *all_fitted_;
    }
    without_queue_ = may_be_without_queue_ && drawn_ && triangles == 0;
    all_fitted_ = triangles <= queue_.size() && blocks <= blocks_.size();
    if (triangles > queue_.size()) queue_ = cellist::Buffer<RasterTriangle>(device_, triangles);
    if (blocks > blocks_.size()) blocks_ = cellist::Buffer<RasterBlock>(device_, blocks);
    return *all_fitted_;
}

}  // namespace raster
