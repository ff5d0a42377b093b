// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "grid/rays.hpp"
#include "grid/triangle_grid.hpp"
#include "pass_times.hpp"
#include "raster/rasteriser.hpp"
#include "scene.hpp"
#include "surfaces.hpp"

namespace shadows {

struct Settings {
    int width = 1024;
    int height = 768;
    int rsm = 512;       ///< texels of the reflective shadow map along each axis
    int samples = 8;     ///< parts of it along each axis; divides `rsm`
    int reduce = 4;      ///< pixels of the picture for each one of buffer B, along each axis
    int interleave = 2;  ///< along each axis: neighbours in B share out the samples; divides these
    int grid = 0;        ///< cells along the longest side, or 0 for as many as suit
    int simplify = 0;    ///< cells of simplified blockers along their longest side, or 0 for none
    cellist::Storage storage = cellist::Storage::linked;
};

/// Throws InputError unless --interleave divides --samples, and these divide --rsm.
void check_settings(const Settings& settings);

/// What a frame counted.
struct FrameCounts {
    std::uint64_t rays = 0;     ///< from pixels of B to emitters that light them
    std::uint64_t blocked = 0;  ///< of them
    cellist::BuildReport build;
};

/// A view of a scene: the nearest surface of each pixel, by the rasteriser.
class SurfaceView {
public:
    SurfaceView(const cellist::Device& device, raster::SetupKernels& setup,
                const raster::Geometry& geometry, const std::vector<raster::Placed>& placed,
                const raster::View& view);
    /// Draws all instances. Blocks until the rasteriser's queues have room for all triangles.
    void draw(raster::Pass& nearest, raster::Pass& surface, cellist::Kernel& clear,
              const raster::Geometry& geometry, const cellist::Buffer<PlacedMesh>& placed,
              const LightSource& from);
    void move(const std::vector<raster::Placed>& placed, const raster::View& view);

    [[nodiscard]] const cellist::Buffer<cl_ulong>& keys() const { return keys_; }
    [[nodiscard]] const cellist::Buffer<Surface>& surfaces() const { return surfaces_; }
    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    raster::Projection projection_;
    raster::Triangles triangles_;
    cellist::Buffer<cl_ulong> keys_;
    cellist::Buffer<Surface> surfaces_;
};

/// Draws frames of a scene with one-bounce indirect light and its shadows.
class Renderer {
public:
    Renderer(const cellist::Device& device, const Scene& scene, const Settings& settings);

    /// What takes the rays of a batch and whether they are blocked.
    using TakeRays =
        std::function<void(const cellist::Buffer<grid::GridSegment>& rays, std::size_t count,
                           const cellist::Buffer<cl_uint>& blocked)>;

    /// Draws the scene as Scene::move has left it. Blocks while the grid is built.
    void draw(const Scene& scene, support::PassTimes* times = nullptr,
              const TakeRays& take_rays = {});

    /// Moves the camera to where the scene has it.
    void follow_camera(const Scene& scene);

    /// What the last frame counted. Blocks.
    [[nodiscard]] FrameCounts counts() const;

    // ---- of the last frame, row by row from the top
    [[nodiscard]] const cellist::Buffer<cl_float4>& picture() const { return picture_; }
    /// The picture without indirect shadows.
    [[nodiscard]] const cellist::Buffer<cl_float4>& unblocked() const { return unblocked_; }
    [[nodiscard]] const cellist::Buffer<cl_float4>& a() const { return a_; }
    /// Of b_width() x b_height() pixels.
    [[nodiscard]] const cellist::Buffer<cl_float4>& b() const { return b_; }
    [[nodiscard]] const cellist::Buffer<cl_float4>& blurred_b() const { return blurred_; }
    [[nodiscard]] const cellist::Buffer<Surface>& surfaces() const { return eye_.surfaces(); }
    /// The reflective shadow map.
    [[nodiscard]] const cellist::Buffer<Surface>& lit() const { return light_.surfaces(); }
    /// The samples' emitters of walls, then their emitters of blockers, row by row.
    [[nodiscard]] const cellist::Buffer<Emitter>& emitters() const { return emitters_; }
    [[nodiscard]] const grid::TriangleGrid& grid() const { return *grid_; }
    [[nodiscard]] const Gather& gather() const { return gather_; }
    [[nodiscard]] int b_width() const {
        return (gather_.width + gather_.reduce - 1) / gather_.reduce;
    }
    [[nodiscard]] int b_height() const {
        return (gather_.height + gather_.reduce - 1) / gather_.reduce;
    }
    /// Rays of B, with those that no sample lights.
    [[nodiscard]] std::size_t rays_in_frame() const;
    /// How many entries of the grid a ray from the eye to each pixel's surface passes. Blocks.
    [[nodiscard]] std::vector<cl_uint> passed_entries(const Scene& scene);
    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    template <class... Uses>
    [[nodiscard]] cellist::Kernel kernel(const char* name, const Uses&... uses) const;
    void gather_blocked(support::PassTimes* times, const TakeRays& take_rays);

    const cellist::Device& device_;
    Gather gather_;
    std::vector<support::Mesh> simplified_;  ///< meshes of blockers, where these are simplified
    raster::Geometry geometry_;
    raster::SetupKernels setup_;
    raster::Pass nearest_;
    raster::Pass surface_;
    cellist::Buffer<PlacedMesh> placed_meshes_;
    SurfaceView eye_;
    SurfaceView light_;
    cellist::Buffer<Blocker> blockers_;
    std::unique_ptr<grid::TriangleGrid> grid_;
    std::unique_ptr<grid::Rays> rays_;
    cellist::Buffer<Emitter> emitters_;
    cellist::Buffer<cl_float4> a_;
    cellist::Buffer<cl_float4> b_;
    cellist::Buffer<cl_float4> b_all_;  ///< the same, blocked or not
    cellist::Buffer<grid::GridSegment> segments_;
    cellist::Buffer<cl_uint> blocked_;
    cellist::Buffer<cl_uint> ray_counts_;
    cellist::Buffer<cl_float4> picture_;
    cellist::Buffer<cl_float4> unblocked_;
    cellist::Buffer<cl_float4> blurred_;
    cellist::Kernel clear_;
    cellist::Kernel place_blockers_;
    cellist::Kernel make_emitters_;
    cellist::Kernel gather_unblocked_;
    cellist::Kernel make_rays_;
    cellist::Kernel gather_blocked_;
    cellist::Kernel compose_;
    cellist::BuildReport build_;
};

}  // namespace shadows
