#pragma once

#include <cstdint>
#include <optional>

#include "look.hpp"
#include "mesh.hpp"
#include "raster/view.hpp"

namespace oit {

/// Everything that determines a picture; the device and the reference draw the same.
struct Frame {
    const support::Mesh& mesh;  ///< transparent, inside of the unit sphere
    raster::View view;
    Look look;
    /// Opaque triangles; none without a floor.
    std::optional<support::Mesh> floor = {};
    /// Nearest layers that are blended in each pixel; none means all.
    std::optional<std::uint32_t> layers = {};
};

/// Two large triangles at look.floor_height.
[[nodiscard]] support::Mesh make_floor(const Look& look);

/// A height at which a floor cuts a little into the underside of the mesh.
[[nodiscard]] float floor_height_under(const support::Mesh& mesh);

}  // namespace oit
