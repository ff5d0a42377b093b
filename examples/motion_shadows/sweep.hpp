// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>

#include "device_types.hpp"
#include "scene.hpp"

namespace motion {

/// The text of a kernel, after lists.clh and moving.clh.
[[nodiscard]] std::string with_moving(std::string_view text);

/// A kernel that works with moving triangles. `uses` as in cellist::Kernel.
template <class... Uses>
[[nodiscard]] cellist::Kernel moving_kernel(const cellist::Device& device, std::string_view text,
                                            const std::string& name, const Uses&... uses) {
    return cellist::Kernel(device, cellist::Source{.text = with_moving(text), .file_name = name},
                           name, cellist::type<View>, cellist::type<MovingVertex>,
                           cellist::type<SweepTile>, cellist::type<Sampling>,
                           cellist::type<Shading>, cellist::type<Receiver>, uses...);
}

/// The triangles of a scene on the device, and the queue of tiles of a sweep.
struct SceneBuffers {
    SceneBuffers(const cellist::Device& device, const Scene& scene);

    cl_uint vertex_count, triangle_count;
    cellist::Buffer<cl_float> begin, end;  ///< 3 a vertex
    cellist::Buffer<cl_uint> indices;      ///< 3 a triangle
    cellist::Buffer<cl_float4> albedos;    ///< of the triangles: linear RGB, and 1
    cellist::Buffer<SweepTile> tiles;
    cellist::Buffer<cl_uint> tile_count;
    cellist::Range tiles_range;
};

/// NO_KEY of keys.clh.
constexpr cl_ulong no_key = 0x7FFFFFFFFFFFFFFF;

/// The scene as the camera or the light sees it.
struct SeenScene {
    /// With `insides`, also those sides of closed surfaces that never show: see seen_sides().
    SeenScene(const cellist::Device& device, const Scene& scene, const View& its_view,
              bool insides = false);
    View view;
    cellist::Buffer<MovingVertex> vertices;
    cellist::Buffer<cl_uchar> sides;  ///< of the triangles: see seen_sides()
};

/// Visits every pixel that each triangle may touch: see sweep.clh.
class Sweep {
public:
    /// `pass` is the text of the pass. `uses` as in cellist::Kernel.
    template <class... Uses>
    Sweep(const cellist::Device& device, std::string_view pass, const Uses&... uses)
        : sweep_(moving_kernel(device, text_of(device, pass), "sweep", uses...)),
          sweep_tiles_(moving_kernel(device, text_of(device, pass), "sweep_tiles", uses...)) {}

    /// Does not block. `targets` are the arguments of the pass.
    template <class... Targets>
    void run(SceneBuffers& scene, const SeenScene& seen, const Targets&... targets) {
        const auto room = static_cast<cl_uint>(scene.tiles.size());
        scene.tile_count.fill(0);
        sweep_.run(cellist::Range::padded(scene.triangle_count, 64), targets..., seen.view,
                   seen.vertices, scene.indices, seen.sides, scene.triangle_count, scene.tiles,
                   room, scene.tile_count);
        sweep_tiles_.run(scene.tiles_range, targets..., seen.view, seen.vertices, scene.indices,
                         seen.sides, scene.tiles, room, scene.tile_count);
    }

private:
    [[nodiscard]] static std::string text_of(const cellist::Device& device, std::string_view pass);
    cellist::Kernel sweep_;
    cellist::Kernel sweep_tiles_;
};

}  // namespace motion
