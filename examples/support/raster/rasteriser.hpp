// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include <cellist/cellist.hpp>

#include "mesh.hpp"
#include "raster/share.hpp"
#include "raster/view.hpp"

namespace raster {

/// The size of buffers.
template <class... T>
[[nodiscard]] std::uint64_t bytes_of(const cellist::Buffer<T>&... buffers) {
    return (std::uint64_t{0} + ... + (buffers.size() * sizeof(T)));
}

/// Meshes on the device, one after the other.
class Geometry {
public:
    /// Throws InputError where the meshes have more than 2^32 / 3 triangles or vertices.
    Geometry(const cellist::Device& device, std::span<const support::Mesh* const> meshes);

    struct Part {
        cl_uint first_vertex, vertices;
        cl_uint first_triangle, triangles;
    };
    [[nodiscard]] const Part& part(std::size_t mesh) const { return parts_.at(mesh); }

    [[nodiscard]] const cellist::Buffer<cl_float>& positions() const { return positions_; }
    /// 3 floats a vertex, as positions().
    [[nodiscard]] const cellist::Buffer<cl_float>& normals() const { return normals_; }
    /// 3 a triangle, of vertices of all meshes.
    [[nodiscard]] const cellist::Buffer<cl_uint>& indices() const { return indices_; }
    [[nodiscard]] std::uint64_t device_bytes() const {
        return bytes_of(positions_, normals_, indices_);
    }

private:
    std::vector<Part> parts_;
    cellist::Buffer<cl_float> positions_;
    cellist::Buffer<cl_float> normals_;
    cellist::Buffer<cl_uint> indices_;
};

/// A mesh of a Geometry at a place in the world.
struct Placed {
    std::size_t mesh = 0;
    glm::dmat4 to_world{1.0};
    cl_uint tag = 0;  ///< for the user's kernels
};

/// How a view sees a mesh, to the last bit as the device does. vertex_offset is left at 0.
[[nodiscard]] RasterInstance instance_of(const Placed& placed, const View& view, cl_uint eye);

/// The build options of every kernel of the rasteriser: correctly rounded division where the device
/// has it, so that the CPU can follow it bit for bit.
[[nodiscard]] std::string build_options(const cellist::Device& device);

/// What the kernels are compiled for.
struct Sampling {
    int samples = 1;           ///< of a pixel: 1, 2, 4 or 8
    bool depth_range = false;  ///< fragments have slopes of their depth
    bool exact = false;        ///< a triangle has a fragment in each pixel that it overlaps
};

/// The beginning of a source that loads triangles again by the numbers of their pieces, and finds
/// their fragments and the part of a pixel that they cover: see raster_load_piece in clip.clh,
/// fragment.clh and pixel.clh.
[[nodiscard]] std::string triangle_text(const cellist::Device& device, const Sampling& sampling);

/// A kernel of the rasteriser. `uses` names the types of the pass, as in cellist::Kernel.
template <class... Uses>
[[nodiscard]] cellist::Kernel make_kernel(const cellist::Device& device,
                                          const cellist::Source& source, const std::string& name,
                                          const Uses&... uses) {
    return cellist::Kernel(device, source, name, cellist::type<View>, cellist::type<RasterInstance>,
                           cellist::type<RasterBatch>, cellist::type<RasterVertex>,
                           cellist::type<RasterTriangle>, cellist::type<RasterBlock>,
                           cellist::type<RasterCounts>, uses...);
}

/// The kernels that every drawing needs, built once for a device.
struct SetupKernels {
    cellist::Kernel transform;
    cellist::Kernel bin;
    explicit SetupKernels(const cellist::Device& device, const Sampling& sampling = {});
};

/// The kernels of one pass: where fragments go is up to its source, which defines RASTER_TARGET,
/// RASTER_TARGET_PASS and raster_emit (see draw.clh).
class Pass {
public:
    /// `uses` names the types of the pass, as in cellist::Kernel.
    template <class... Uses>
    Pass(const cellist::Device& device, const Sampling& sampling, std::string_view source,
         const std::string& name, const Uses&... uses) {
        const auto kernel = [&](EdgeBits edge_bits, const char* kernel_name) {
            return make_kernel(device, pass_source(device, sampling, source, name, edge_bits),
                               kernel_name, uses...);
        };
        if (draws_at_once(device)) {
            all_.emplace(kernel(EdgeBits::wide, "raster_draw"));
        } else {
            small_.emplace(kernel(EdgeBits::narrow, "raster_draw_small"));
            blocks_.emplace(kernel(EdgeBits::wide, "raster_draw_blocks"));
        }
    }

private:
    friend class Triangles;
    // Edge functions of small triangles fit in 32 bits, those of large ones need 64.
    enum class EdgeBits { narrow, wide };
    static bool draws_at_once(const cellist::Device& device);
    static cellist::Source pass_source(const cellist::Device& device, const Sampling& sampling,
                                       std::string_view source, const std::string& name,
                                       EdgeBits edge_bits);
    std::optional<cellist::Kernel> all_;  ///< on GPUs: small triangles and blocks
    std::optional<cellist::Kernel> small_;
    std::optional<cellist::Kernel> blocks_;
};

/// Instances of meshes, projected into one or more views of the same size: a view an eye.
class Projection {
public:
    /// Refers to the geometry and the kernels, which must outlive it.
    Projection(const cellist::Device& device, SetupKernels& kernels, const Geometry& geometry,
               std::span<const Placed> placed, std::span<const View> views);

    /// Moves the instances, which stay as many as they were, and the eyes. Blocks.
    void move(std::span<const Placed> placed, std::span<const View> views);

    /// Projects the vertices, unless kernels do so where they load triangles. Does not block.
    void transform() {
        if (projects_once_)
            kernels_.transform.run(vertex_range_, views_, instances_, batches_,
                                   geometry_.positions(), vertices_);
    }

    [[nodiscard]] const cellist::Buffer<View>& views() const { return views_; }
    [[nodiscard]] std::uint64_t device_bytes() const {
        return bytes_of(views_, instances_, batches_, vertices_);
    }

private:
    friend class Triangles;
    [[nodiscard]] std::size_t triangles_of(std::span<const std::size_t> chosen) const;
    [[nodiscard]] std::vector<RasterBatch> triangle_batches(std::span<const std::size_t> chosen,
                                                            std::size_t most) const;

    SetupKernels& kernels_;
    const Geometry& geometry_;
    bool projects_once_;
    std::size_t eyes_;
    std::vector<std::size_t> meshes_;  ///< of the instances, in each eye
    cellist::Buffer<View> views_;
    cellist::Buffer<RasterInstance> instances_;
    cellist::Buffer<RasterBatch> batches_;
    cellist::Buffer<RasterVertex> vertices_;
    cellist::Range vertex_range_;
};

struct Batching;

/// The triangles of some of the instances: divides the large ones into blocks of pixels, and draws
/// all any number of times.
class Triangles {
public:
    /// `chosen` are indices of the projection's instances. Refers to the projection, which must
    /// outlive it.
    Triangles(const cellist::Device& device, const Projection& projection,
              std::span<const std::size_t> chosen, const Share& share = {});

    /// Puts the large triangles and their blocks into queues. Does nothing on GPUs while all
    /// triangles are small. Does not block.
    void bin() {
        if (!without_queue_) {
            turn_ = 1 - turn_;
            run(projection_.kernels_.bin, group_range_, counts_, turn_, queue_, capacity_of(queue_),
                blocks_, capacity_of(blocks_), small_pixels_);
        }
        drawn_ = false;
        counted_.reset();
        all_fitted_.reset();
    }

    /// Starts the read that finish_or_grow() waits for, which otherwise starts it. A read between
    /// kernels makes the device wait.
    void read_counts() { counted_ = counts_.download_async(); }

    /// What kernels of the user take that leave a word for the host: RasterCounts::note.
    [[nodiscard]] const cellist::Buffer<RasterCounts>& counts() const { return counts_; }
    /// That word, as the last finish_or_grow() read it.
    [[nodiscard]] cl_uint note() const { return note_; }

    /// Waits for the counts. False if the queues had no room for all, and have grown, or if a frame
    /// without queues met a large triangle: the next bin() fills queues. Whoever has drawn since
    /// bin() begins again there.
    [[nodiscard]] bool finish_or_grow();

    /// Draws with a pass whose RASTER_TARGET takes `targets`. Does not block.
    template <class... Targets>
    void draw(Pass& pass, const Targets&... targets) {
        const auto run_on_queues = [&](cellist::Kernel& kernel, const cellist::Range& range,
                                       const auto&... args) {
            run(kernel, range, args..., counts_, turn_, queue_, capacity_of(queue_), blocks_,
                capacity_of(blocks_));
        };
        drawn_ = true;
        if (pass.all_) {
            run_on_queues(*pass.all_, without_queue_ ? group_range_ : block_range_, targets...,
                          static_cast<cl_uint>(batches_.size()), small_pixels_, waiting_pixels_);
        } else {
            run(*pass.small_, group_range_, targets..., small_pixels_);
            run_on_queues(*pass.blocks_, block_range_, targets...);
        }
    }

    /// Runs a kernel whose last parameters are RASTER_SCENE. Does not block.
    template <class... Args>
    void run(cellist::Kernel& kernel, const cellist::Range& range, const Args&... args) {
        const Projection& p = projection_;
        kernel.run(range, args..., p.views_, p.instances_, p.vertices_, p.geometry_.positions(),
                   p.geometry_.indices(), batches_);
    }

    [[nodiscard]] std::uint64_t device_bytes() const {
        return bytes_of(batches_, queue_, blocks_, counts_);
    }

private:
    Triangles(const cellist::Device& device, const Projection& projection,
              std::span<const std::size_t> chosen, const Share& share, const Batching& batching);
    template <class T>
    [[nodiscard]] static cl_uint capacity_of(const cellist::Buffer<T>& queue) {
        return static_cast<cl_uint>(queue.size());
    }

    const cellist::Device& device_;
    const Projection& projection_;
    cellist::Buffer<RasterBatch> batches_;
    cl_int small_pixels_;         ///< the size up to which triangles are not divided into blocks
    cellist::Range group_range_;  ///< a work-group for each batch
    cellist::Range block_range_;  ///< for blocks; on GPUs, group_range_ and more
    cellist::LocalMemory waiting_pixels_;  ///< of a work-group, on GPUs
    cellist::Buffer<RasterTriangle> queue_;
    cellist::Buffer<RasterBlock> blocks_;
    cellist::Buffer<RasterCounts> counts_;  ///< of this bin() and the next, which take turns
    cl_uint note_ = 0;
    cl_uint turn_ = 0;
    std::optional<cellist::Pending<std::vector<RasterCounts>>> counted_;
    std::optional<bool> all_fitted_;  ///< into the queues at the last bin(), once it is known
    bool drawn_ = false;              ///< since the last bin()
    // On GPUs, if all triangles are small: bin() does nothing, and draw() looks for others.
    bool without_queue_ = false;
    bool may_be_without_queue_;
};

}  // namespace raster
