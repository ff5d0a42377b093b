#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>

#include "mesh.hpp"
#include "raster/view.hpp"

namespace raster {

/// A piece of a large or clipped triangle in a tile's list.
struct RasterBinned {
    cl_uint triangle;
    cl_uint piece;
};
CELLIST_STRUCT(RasterBinned, triangle, piece);

/// A mesh on the device.
struct DeviceMesh {
    cellist::Buffer<cl_float> positions;  ///< 3 a vertex
    cellist::Buffer<cl_float> normals;    ///< 3 a vertex
    cellist::Buffer<cl_uint> indices;     ///< 3 a triangle
    cl_uint vertices;
    cl_uint triangles;

    /// Throws InputError where the mesh has more than 2^32 / 3 triangles or vertices.
    DeviceMesh(const cellist::Device& device, const support::Mesh& mesh);

    [[nodiscard]] std::uint64_t bytes() const;
};

/// The build options of every kernel of the rasteriser: correctly rounded division where the device
/// has it, so that the CPU can follow it bit for bit.
[[nodiscard]] std::string build_options(const cellist::Device& device);
[[nodiscard]] bool divides_exactly(const cellist::Device& device);

/// The kernels of one pass: where samples go is up to its source, which defines RASTER_TARGET,
/// RASTER_TARGET_PASS and raster_emit (see draw.clh).
class Pass {
public:
    /// `uses` names the types of the pass, as in cellist::Kernel.
    template <class... Uses>
    Pass(const cellist::Device& device, std::string_view source, const std::string& name,
         const Uses&... uses)
        : small_(device, pass_source(device, source, name), "raster_draw_small",
                 cellist::type<View>, cellist::type<RasterVertex>, cellist::type<RasterBinned>,
                 uses...),
          tiles_(device, pass_source(device, source, name), "raster_draw_tiles",
                 cellist::type<View>, cellist::type<RasterVertex>, cellist::type<RasterBinned>,
                 uses...) {}

private:
    friend class Drawing;
    static cellist::Source pass_source(const cellist::Device& device, std::string_view source,
                                       const std::string& name);
    cellist::Kernel small_;
    cellist::Kernel tiles_;
};

/// The kernels that every pass needs, built once for a device.
struct SetupKernels {
    cellist::Kernel transform;
    cellist::Kernel bin;
    explicit SetupKernels(const cellist::Device& device);
};

/// One mesh in one image: transforms it, sorts its large triangles into screen tiles, and draws it
/// any number of times.
class Drawing {
public:
    /// Refers to the mesh and the kernels, which must outlive it.
    Drawing(const cellist::Device& device, SetupKernels& kernels, const DeviceMesh& mesh,
            const View& view);

    /// Projects the vertices. Does not block.
    void transform();

    /// Fills the tiles. Blocks until they are filled.
    void bin();

    /// Draws with a pass whose RASTER_TARGET takes `targets`. Does not block.
    template <class... Targets>
    void draw(Pass& pass, const Targets&... targets) {
        pass.small_.run(cellist::Range::padded(mesh_.triangles, 64), targets..., view_, vertices_,
                        mesh_.indices, mesh_.triangles);
        if (has_bins_)
            pass.tiles_.run(tile_rows(), targets..., bins_, view_, vertices_, mesh_.positions,
                            mesh_.indices);
    }

    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    [[nodiscard]] cellist::Range tile_rows() const;

    SetupKernels& kernels_;
    const DeviceMesh& mesh_;
    View view_;
    cellist::Buffer<RasterVertex> vertices_;
    cellist::Lists<RasterBinned> bins_;
    bool has_bins_ = false;
};

}  // namespace raster
